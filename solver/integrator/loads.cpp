#include "solver/integrator/loads.hpp"

#include <algorithm>

namespace talus::solver {

std::vector<Vec3<double>> load_densities(const std::vector<Load>& loads, const std::vector<double>& volumes,
                                         double time) {
  std::vector<Vec3<double>> densities;
  for (std::size_t l = 0; l < volumes.size(); ++l) {
    const Load& load = loads[l];
    double share = time >= load.from && time < load.to ? 1.0 : 0.0;
    if (load.ramp > 0) share *= std::clamp((time - load.from) / load.ramp, 0.0, 1.0);
    const double scale = share / volumes[l];
    densities.push_back({load.force.x * scale, load.force.y * scale, load.force.z * scale});
  }
  return densities;
}

}  // namespace talus::solver
