// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/ensemble.hpp"

#include <utility>

#include <fmt/format.h>

#include "common/ensemble/names.hpp"
#include "common/stage/identity.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// How many failures are told by their reasons; all stand in members.csv.
constexpr std::size_t failures_told = 5;

EnsembleCounts read_parts(const std::vector<fs::path>& files) {
  std::vector<EnsembleCounts> parts;
  for (const fs::path& file : files) {
    stop_if_interrupted("reading " + file.string());
    parts.push_back(read_counts(file));
  }
  return merged(std::move(parts), files);
}

/// Refuses counts of other members, or of a domain that another recipe made.
void judge_counts(const StageContext& context, const fs::path& file, const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  if (counts.members != ensemble.table.count)
    throw DataError({fmt::format("{}: counts of an ensemble of {} members", file.string(), counts.members),
                     fmt::format("{} has {}", ensemble.files.front().string(), ensemble.table.count),
                     "Run talus-solve again"});
  const std::string of = fact(ensemble.table.provenance, base_domain_id), is = fact(counts.provenance, domain_id);
  if (!of.empty() && !is.empty() && of != is)
    throw DataError({fmt::format("{}: counts of members of the domain {}", file.string(), is),
                     fmt::format("{} names the domain {}", ensemble.files.front().string(), of),
                     "Run talus-solve again"});
  for (const auto& [table, name, program] : {std::tuple{"solve", recipe_of_run, "talus-solve"},
                                             std::tuple{"preprocess", recipe_of_domain, "talus-preprocess and solve"}})
    if (!fact(counts.provenance, name).empty())
      judge_maker(context.recipe,
                  {.file = file, .table = table, .mark = fact(counts.provenance, name), .program = program, .key = ""});
}

void tell_of_edges(const Ensemble& ensemble) {
  const std::vector<std::int64_t> members = ensemble.counts.at_edge();
  if (members.empty()) return;
  warn("members-at-edge",
       fmt::format("{} came to the edge of their domain: {}; what lies beyond is missing from maps and numbers",
                   members.size() == 1 ? "one member" : fmt::format("{} members", members.size()),
                   ensemble.table.slides ? ensemble.table.names_of(members, 12) : member_list(members)));
}

void tell_of_members(const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  std::vector<std::int64_t> waiting;
  for (std::size_t k = 0; k < counts.states.size(); ++k)
    if (counts.states[k] == MemberState::waiting) waiting.push_back(static_cast<std::int64_t>(k));
  if (!waiting.empty())
    warn("members-not-run",
         fmt::format("{} of {} members have not been run: {}; the results are of the others, and talus-solve "
                     "runs them",
                     waiting.size(), counts.members, member_list(waiting)));
  std::vector<std::int64_t> failed;
  for (const MemberWords& failure : counts.failures) {
    if (failed.size() < failures_told)
      warn("member-failed", fmt::format("{} failed: {}", ensemble.table.name_of(failure.member), failure.words));
    failed.push_back(failure.member);
  }
  if (!failed.empty())
    warn("members-failed",
         fmt::format("{} of {} members failed ({}) and are left out of all counts; members.csv has the reasons",
                     failed.size(), counts.members, member_list(failed)));
  tell_of_edges(ensemble);
}

}  // namespace

std::vector<fs::path> ensemble_files(const fs::path& out) {
  const EnsemblePaths paths{out};
  std::vector<fs::path> files = paths.found_counts();
  if (files.empty()) files.push_back(paths.counts());
  files.insert(files.begin(), paths.members());
  return files;
}

Ensemble read_ensemble(const StageContext& context) {
  Ensemble ensemble;
  ensemble.files = ensemble_files(context.out);
  ensemble.table = read_member_table(ensemble.files.front());
  judge_members(context.recipe, ensemble.files.front(), ensemble.table);
  ensemble.counts = read_parts({ensemble.files.begin() + 1, ensemble.files.end()});
  judge_counts(context, ensemble.files[1], ensemble);
  if (ensemble.counted() == 0)
    throw DataError({fmt::format("{}: no member is counted", ensemble.files[1].string()),
                     fmt::format("{} failed and {} wait", ensemble.failed(), ensemble.waiting()),
                     "See what talus-solve said of them, mend the recipe, and run it again"});
  tell_of_members(ensemble);
  return ensemble;
}

RunMaps base_maps(const EnsembleScene& scene) {
  RunMaps maps;
  maps.grid = scene.grid;
  maps.threshold = scene.threshold;
  maps.terrain = scene.terrain;
  maps.before = scene.before;
  maps.initial_thickness = scene.release_thickness;
  maps.deposit_thickness.assign(scene.grid.count(), 0.0);
  maps.peak_thickness = maps.deposit_thickness;
  return maps;
}

std::string member_list(const std::vector<std::int64_t>& members, std::size_t most) {
  std::string text;
  std::size_t items = 0;
  for (std::size_t k = 0; k < members.size();) {
    if (items++ == most) return text + fmt::format(" and {} more", members.size() - k);
    std::size_t end = k + 1;
    while (end < members.size() && members[end] == members[end - 1] + 1) ++end;
    const char* comma = text.empty() ? "" : ", ";
    if (end - k < 3) {
      text += fmt::format("{}{}", comma, members[k++]);
    } else {
      text += fmt::format("{}{} to {}", comma, members[k], members[end - 1]);
      k = end;
    }
  }
  return text;
}

std::string members_words(const Ensemble& ensemble) {
  const std::int64_t left_out = ensemble.counts.count(MemberState::left_out);
  return fmt::format("{} of {} members are counted, {} failed, {} wait", ensemble.counted(), ensemble.counts.members,
                     ensemble.failed(), ensemble.waiting()) +
         (left_out > 0 ? fmt::format(", {} left out", left_out) : "");
}

}  // namespace talus::postprocess
