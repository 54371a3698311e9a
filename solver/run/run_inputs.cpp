// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_inputs.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/stage/checksum.hpp"

namespace talus::solver {

void find_obstacles(SolveOptions& o, const std::filesystem::path& out) {
  for (ObstacleOptions& obstacle : o.obstacles) {
    if (obstacle.body || !obstacle.level_set.empty()) continue;
    obstacle.level_set = out / "obstacles.vdb";
    if (obstacle.grid.empty()) obstacle.grid = obstacle.name;
  }
}

SolveOptions options_of(const recipe::Recipe& recipe, const std::filesystem::path& out) {
  SolveOptions options = with_preset(recipe.read<SolveOptions>("solve"));
  find_obstacles(options, out);
  return options;
}

std::vector<std::filesystem::path> inputs_of(const SolveOptions& options, const std::filesystem::path& out) {
  std::vector<std::filesystem::path> inputs{options.domain.empty() ? out / "domain.vdb" : options.domain};
  for (const ObstacleOptions& obstacle : options.obstacles)
    if (std::find(inputs.begin(), inputs.end(), obstacle.level_set) == inputs.end())
      inputs.push_back(obstacle.level_set);
  for (const InflowOptions& inflow : options.inflows)
    if (!inflow.file.empty()) inputs.push_back(inflow.file);
  if (options.shaking.acts()) inputs.push_back(options.shaking.file);
  return inputs;
}

std::string fingerprint_of(const std::filesystem::path& domain, const SolveOptions& options) {
  std::string fingerprint = checksum_as_read(domain) + "\n" + recipe::to_toml(options, "solve", false);
  for (const ObstacleOptions& obstacle : options.obstacles) fingerprint += sha256(obstacle.level_set) + "\n";
  for (const InflowOptions& inflow : options.inflows)
    if (!inflow.file.empty()) fingerprint += sha256(inflow.file) + "\n";
  if (options.shaking.acts()) fingerprint += sha256(options.shaking.file) + "\n";
  return fingerprint;
}

Facts made_by(const StageContext& context, const SolveOptions& o) {
  Facts facts{{recipe_of_run, recipe_mark(context.recipe, "solve")}};
  for (std::size_t n = 0; n < o.inflows.size(); ++n)
    if (!o.inflows[n].file.empty())
      facts.emplace_back("hydrograph." + inflow_name(o.inflows[n], n) + ".sha256", sha256(o.inflows[n].file));
  if (o.shaking.acts()) facts.emplace_back(shaking_checksum, sha256(o.shaking.file));
  return facts;
}

void judge_inputs(const StageContext& context, const SolveOptions& o, const std::filesystem::path& file,
                  const Domain& domain) {
  judge_maker(context.recipe, {.file = file,
                               .table = "preprocess",
                               .mark = fact(domain.provenance, recipe_of_domain),
                               .program = "talus-preprocess",
                               .key = "domain in [solve]",
                               .named = !o.domain.empty()});
  const std::string written = fact(domain.provenance, obstacles_checksum);
  const auto bodies = context.out / "obstacles.vdb";
  const auto reads = [&](const ObstacleOptions& obstacle) { return obstacle.level_set == bodies; };
  if (!written.empty() && std::filesystem::exists(bodies) &&
      std::any_of(o.obstacles.begin(), o.obstacles.end(), reads)) {
    if (const std::string found = sha256(bodies); found != written)
      throw DataError(
          {bodies.string() + ": not the file that was written with " + file.string(),
           fmt::format("its SHA-256 is {:.16}..., that of the file written with it {:.16}...", found, written),
           "Run talus-preprocess again"});
  }
}

}  // namespace talus::solver
