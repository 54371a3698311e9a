// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/weaken.hpp"

#include <algorithm>
#include <utility>

namespace talus::solver {
namespace {

template <class Change>
void change_materials(SolveOptions& options, const Change& change) {
  change(options.material);
  for (PartOptions& part : options.parts) change(part.material);
}

void weaken(MaterialOptions& m, double factor) {
  visit_law(m.model, [&](auto law) {
    typename decltype(law)::Options& options = m;
    if constexpr (requires { options.weaken(factor); }) options.weaken(factor);
  });
}

void weaken(Bed<double>& bed, FrictionLaw law, double factor) {
  bed.cohesion /= factor;
  visit_law(law, [&](auto own) {
    if constexpr (requires { own.weaken(bed.numbers, factor); }) own.weaken(bed.numbers, factor);
  });
}

}  // namespace

double stiffening_of(const Domain& domain, const SolveOptions& options) {
  const auto& heights = domain.points.height;
  const double depth = heights.empty() ? 0 : *std::max_element(heights.begin(), heights.end());
  const double gravity = options.gravity_size();
  double strain = 0;
  options.any_material([&](const MaterialOptions& m) {
    const double speed = make_material<double>(m).wave_speed;
    strain = std::max(strain, gravity * depth / (speed * speed));
    return false;
  });
  return std::max(1.0, strain / strain_of_searches);
}

SolveOptions stiffened(SolveOptions options, double factor) {
  change_materials(options, [&](MaterialOptions& m) { m.youngs_modulus *= factor; });
  return options;
}

SolveOptions weakened(SolveOptions options, double factor) {
  change_materials(options, [&](MaterialOptions& m) { weaken(m, factor); });
  return options;
}

BaseFriction<double> weakened(BaseFriction<double> bed, double factor) {
  weaken(bed.uniform, bed.law, factor);
  return bed;
}

std::vector<Bed<double>> weakened(std::vector<Bed<double>> columns, FrictionLaw law, double factor) {
  for (Bed<double>& column : columns) weaken(column, law, factor);
  return columns;
}

}  // namespace talus::solver
