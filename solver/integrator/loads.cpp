// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/loads.hpp"

#include <algorithm>
#include <cstddef>

namespace talus::solver {

std::vector<Vec3<double>> load_densities(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes,
                                         double begin, double time) {
  std::vector<Vec3<double>> densities;
  for (std::size_t l = 0; l < volumes.size(); ++l) {
    const LoadOptions& load = loads[l];
    double share = begin >= load.from && begin < load.to ? 1.0 : 0.0;
    if (load.ramp > 0) share *= std::clamp((time - load.from) / load.ramp, 0.0, 1.0);
    const double scale = share / volumes[l];
    densities.push_back({load.force[0] * scale, load.force[1] * scale, load.force[2] * scale});
  }
  return densities;
}

bool loads_jump(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes, double time) {
  const auto jumps = [time](const LoadOptions& load) {
    return (time == load.from && !(load.ramp > 0)) || time == load.to;
  };
  return std::any_of(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(volumes.size()), jumps);
}

}  // namespace talus::solver
