// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/keep_runs.hpp"

#include <optional>
#include <string>

#include <fmt/format.h>

#include "common/run/run_facts.hpp"
#include "common/stage/findings.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/run/run_stage.hpp"
#include "solver/run/simulation.hpp"

namespace talus::solver {
namespace {

/// The fact by which a kept run knows its ensemble and member.
constexpr const char* kept_member = "ensemble.member";

}  // namespace

void keep_runs(StageContext& context, const Members& members, const EnsembleOptions& options,
               const EnsemblePaths& paths, const AnyDevice& device, const EnsembleCounts& counts) {
  for (std::int64_t k = counts.part.first; k < counts.part.end; ++k) {
    const MemberState state = counts.states[static_cast<std::size_t>(k - counts.part.first)];
    if ((!options.keeps("all") && !options.keeps(std::to_string(k))) || state == MemberState::left_out) continue;
    const RunPaths files(paths.run_folder(k));
    const std::string mark = fmt::format("{} {}", counts.fingerprint, k);
    if (std::filesystem::exists(files.run) && fact(run_facts(files.run), kept_member) == mark) {
      remove_leftovers(files);
      continue;
    }
    log_info(fmt::format("member {}: its whole run is kept", k));
    std::optional<Simulation> simulation;
    Facts facts{{kept_member, mark}};
    std::string failure = failure_of([&] {
      const auto own = members.plan(k);
      facts.insert(facts.begin(), own->domain->provenance.begin(), own->domain->provenance.end());
      simulation.emplace(own, device, files, mark);
    });
    if (failure.empty()) {
      make_folder(paths.run_folder(k));
      take_up(*simulation, {.resume = true}, files, mark);
      try {
        simulation->run(context.recipe.scene_name(), fmt::format("{}, member {}", context.recipe.title(), k), facts);
        context.results.push_back(files.run);
      } catch (const NumericalError& error) {  // all else that goes wrong here is the disk's
        failure = error.what();
      }
    }
    // It is counted as failed when its turn comes.
    if (!failure.empty()) warn("member-not-kept", fmt::format("member {} leaves no run: {}", k, failure));
  }
}

}  // namespace talus::solver
