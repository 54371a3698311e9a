// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/maps_of_ensemble.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace talus::postprocess {

double standard_error(double share, double draws) {
  return std::sqrt(share * (1 - share) * draws + 0.25) / (draws + 1);
}

double members_to_halve(double share, double draws) {
  const double pq = share * (1 - share), e = standard_error(share, draws);
  return (pq + std::sqrt(pq * pq + e * e * (0.25 - pq))) / (0.5 * e * e) - 1;  // (e m / 2)^2 = pq m + 1/4 - pq, less 1
}

double independent_draws(const MemberTable& table, std::int64_t counted) {
  const auto members = static_cast<double>(counted);
  if (table.sample_size <= 0 || table.count <= 0) return members;
  return members * static_cast<double>(table.sample_size) / static_cast<double>(table.count);
}

bool is_probability(const std::string& design) {
  return design != "slides" && design != "budget" && design != "one-at-a-time" && design != "table" &&
         design != "full-grid";
}

ShareWords share_words(const std::string& design) {
  const std::string given = "Share of the counted members: the probability, given the distributions in [ensemble].";
  if (design == "one-at-a-time")
    return {"Share of the counted members. They vary one key at a time: this is no probability.",
            "The error that as many independent draws would have; it says nothing of this design."};
  if (design == "full-grid")
    return {"Share of the counted members, which are all combinations of equally probable values of each key.",
            "The error that as many independent draws would have; a grid's own error depends on its levels."};
  if (design == "slides")
    return {"Share of the counted slides. They are different slides and not draws of one: this is no probability.",
            "Slides are no sample, so their share has no sampling error."};
  if (design == "table")
    return {"Share of the counted members, which a table lists: a probability only where its rows were drawn from one.",
            "The error that as many independent draws would have."};
  if (design == "posterior")
    return {
        "Share of the members, which a calibration drew: the probability, given the distributions in [ensemble] and "
        "the survey.",
        "The error that as many independent draws would have; draws of a calibration are not quite independent."};
  if (design == "sensitivity")
    return {given, "Standard error of one of the design's blocks of independent draws: an upper bound of the error."};
  if (design == "monte-carlo") return {given, "Standard error of the share."};
  return {given, "Standard error of as many independent draws; a stratified design usually has a smaller one."};
}

Convergence convergence(const std::vector<double>& values, std::size_t points) {
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  Convergence steps;
  double mean = 0, squares = 0;  // Welford's (1962)
  std::size_t told = 0;
  for (std::size_t n = 1; n <= known.size(); ++n) {
    const double before = known[n - 1] - mean;
    mean += before / static_cast<double>(n);
    squares += before * (known[n - 1] - mean);
    const std::size_t step = n * std::min(points, known.size()) / known.size();
    if (step == told) continue;
    told = step;
    const auto count = static_cast<double>(n);
    steps.members.push_back(static_cast<std::int64_t>(n));
    steps.mean.push_back(mean);
    steps.error.push_back(n > 1 ? std::sqrt(squares / (count - 1) / count) : nan);
  }
  return steps;
}

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
  for (const auto* list : {&ensemble.counts.findings, &ensemble.findings})
    for (Finding finding : *list) {
      if (finding.severity != Severity::refusal || is_accepted(all, finding.name)) continue;
      if (finding.member != Finding::no_member)
        finding.message = fmt::format("in member {}, and maybe in others: {}", finding.member, finding.message);
      all.push_back(std::move(finding));
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

RasterTags raster_tags(const std::string& title, const std::string& unit, Facts facts) {
  const std::string shown = unit_words(unit);
  return {fmt::format("{} [{}]", title, shown.empty() ? "-" : shown), shown, std::move(facts)};
}

RasterTags map_tags(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard,
                    const char* no_data) {
  Facts facts = ensemble_facts(ensemble);
  for (auto& fact : map_facts(ensemble, map, hazard)) facts.push_back(std::move(fact));
  facts.emplace_back("NODATA_MEANING", no_data);
  return raster_tags(map.title, map.unit, std::move(facts));
}

}  // namespace talus::postprocess
