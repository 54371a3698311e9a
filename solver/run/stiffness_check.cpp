// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stiffness_check.hpp"

#include <cmath>

#include <fmt/format.h>

#include "common/run/run_file.hpp"
#include "solver/run/simulation.hpp"

namespace talus::solver {

void check_stiffness(const Plan& first, const AnyDevice& device, const StageContext& context,
                     const std::filesystem::path& run) {
  SolveOptions o = first.options;
  o.material.youngs_modulus *= 2;
  for (PartOptions& part : o.parts) part.material.youngs_modulus *= 2;
  log_info(fmt::format("stiffness check: once more with {:.3g} Pa", o.material.youngs_modulus));
  const auto folder = context.out / "stiffness-check";
  std::filesystem::create_directories(folder);
  const RunPaths paths(folder);
  Simulation(plan(first.domain, o, Settle::done), device, paths, "")
      .run(context.recipe.scene_name(), context.recipe.title());
  const Run soft = read_run(run), stiff = read_run(paths.run);
  double moved = 0, all = 0;
  for (std::size_t n = 0; n < soft.maps.deposit_thickness.size(); ++n) {
    const double a = soft.maps.deposit_thickness[n], b = stiff.maps.deposit_thickness[n];
    if (std::isfinite(a) && std::isfinite(b)) {
      moved += 0.5 * std::abs(a - b);
      all += b;
    }
  }
  log_info(fmt::format("stiffness check: {:.2f} % of the deposit lies elsewhere with {:.3g} Pa",
                       all > 0 ? 100 * moved / all : 0, o.material.youngs_modulus));
}

}  // namespace talus::solver
