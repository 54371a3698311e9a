// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/facts.hpp"

#include <fmt/format.h>

#include "postprocess/ensemble/hazard.hpp"
#include "postprocess/ensemble/sampling_error.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

std::string statistic_words(const Ensemble& ensemble, const EnsembleMap& map) {
  if (counted_maps[map.tally].early)
    return map.kind == Kind::quantile ? "members that do not arrive count as beyond all others: no data where fewer "
                                        "than that share arrive"
                                      : "over the members that arrive there; no data where none does";
  return fmt::format("over all {} counted members; those that did not reach a cell count as 0 there",
                     ensemble.counted());
}

}  // namespace

std::vector<Finding> insisted_on(const Ensemble& ensemble) {
  std::vector<Finding> all;
  for (const auto* list : {&ensemble.counts.findings, &ensemble.findings}) {
    for (Finding finding : *list) {
      if (finding.severity != Severity::refusal || is_accepted(all, finding.name)) continue;
      if (finding.member != Finding::no_member)
        finding.message = fmt::format("in member {}, and maybe in others: {}", finding.member, finding.message);
      all.push_back(std::move(finding));
    }
  }
  return all;
}

Facts ensemble_facts(const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  Facts facts{{"TITLE", counts.scene.title},
              {"SCENE", counts.scene.scene},
              {"DESIGN", ensemble.table.design},
              {"SEED", std::to_string(ensemble.table.seed)},
              {"MEMBERS", std::to_string(counts.members)},
              {"MEMBERS_COUNTED", std::to_string(ensemble.counted())},
              {"MEMBERS_FAILED", std::to_string(ensemble.failed())},
              {"MEMBERS_WAITING", std::to_string(ensemble.waiting())},
              {"FLOW_THRESHOLD_M", fmt::format("{}", counts.scene.threshold)},
              {"THICKNESS_CONVENTION", "vertical thickness, measured along the plumb line (not normal to the slope)"},
              {"ENSEMBLE_FINGERPRINT", counts.fingerprint},
              {"SOURCE", "Talus " + version()}};
  if (const std::string line = accepted_line(insisted_on(ensemble)); !line.empty())
    facts.emplace_back("ACCEPTED", line);
  return facts;
}

Facts map_facts(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard) {
  const CountedMap& what = counted_maps[map.tally];
  const ShareWords words = share_words(ensemble.table.design);
  Facts facts{{"QUANTITY", map.title}};
  switch (map.kind) {
    case Kind::share:
    case Kind::error:
    case Kind::to_halve:
      facts.emplace_back("THRESHOLD", fmt::format("{}", map.level));
      facts.emplace_back("THRESHOLD_UNIT", unit_words(what.unit));
      facts.emplace_back("THRESHOLD_OF", words_of(what));
      facts.emplace_back("MEANING", words.meaning);
      facts.emplace_back("ERROR_MEANING", words.error + " Half the width of Wilson's interval at one sigma.");
      facts.emplace_back("INDEPENDENT_DRAWS",
                         fmt::format("{:g}", independent_draws(ensemble.table, ensemble.counted())));
      break;
    case Kind::quantile:
      facts.emplace_back("SHARE", fmt::format("{}", map.level));
      facts.emplace_back("RESOLUTION", fmt::format("by bins whose edges grow by a factor of {}", what.ratio));
      [[fallthrough]];
    case Kind::mean:
    case Kind::count:
    case Kind::largest:
    case Kind::deviation: facts.emplace_back("MEANING", statistic_words(ensemble, map)); break;
    case Kind::hazard:
      facts.emplace_back("HAZARD_MATRIX", hazard_words(hazard_rule(ensemble, hazard).value()));
      facts.emplace_back("MEANING", "largest class that any of these gives; 0 where none does. " + words.meaning);
      break;
  }
  return facts;
}

}  // namespace talus::postprocess
