// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Water that flows along a column: Terzaghi's consolidation in pressure and settlement, one and two ways drained, by
// all steps that have inertia.
#include <algorithm>
#include <cmath>

#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double height = 8, side = 1;                // of the column [m]
constexpr double load = 1e5, pull = 0.02;             // [Pa], [m/s2]
constexpr double modulus = 1e8, coefficient = 10;     // of the skeleton [Pa], of consolidation [m2/s]
constexpr double loaded_from = 0.05, loading = 0.02;  // [s]

/// How a column drains, and how its steps are taken.
struct Column {
  Integrator integrator = Integrator::explicit_;
  int layers = 8;
  bool both_ways = false;

  double layer() const { return height / layers; }
  double path() const { return both_ways ? height / 2 : height; }
  /// The time at which the time factor is t, since the middle of the loading [s].
  double time_of(double t) const { return loaded_from + loading / 2 + t * path() * path() / coefficient; }
};

SolveOptions options_of(const Column& c) {
  SolveOptions o = elastic_options(5e9, c.integrator);  // without drainage 50 times as stiff as the skeleton
  o.material.poisson_ratio = 0;
  o.gravity = {0, 0, -pull};
  o.damping = 0.2;
  o.base.law = FrictionLaw::stick;
  o.walls = rollers(0, side);
  o.loads = {{.extent = {0, 0, side, side, height - c.layer() / 2, height},
              .force = {0, 0, -load * side * side},
              .ramp = loading,
              .from = loaded_from}};
  o.water.compressibility = 1;
  o.water.reference_stress = modulus / o.water.solid_fraction;
  o.water.permeability = coefficient / modulus * o.water.viscosity;
  if (c.both_ways) o.water.bed = Drainage::drained;
  o.implicit.step = 0.003;
  o.largest_step = 0.02;
  o.map_threshold = 0.1;
  return o;
}

/// The sum of scale(m) exp(-m^2 t) over Terzaghi's m = (2n + 1) pi / 2.
template <class Scale>
double series(double t, const Scale& scale) {
  double sum = 0;
  for (int n = 0; n < 200; ++n) {
    const double m = (2 * n + 1) * M_PI / 2;
    sum += scale(m) * std::exp(-m * m * t);
  }
  return sum;
}
/// The excess pressure over the load, at a depth below the drained side over the path (Terzaghi 1925).
double excess_at(double depth, double t) {
  return series(t, [&](double m) { return 2 / m * std::sin(m * depth); });
}
/// The settlement of what lies at such a depth over the load, path and compliance.
double settlement_at(double depth, double t) {
  return 1 - depth - series(t, [&](double m) { return 2 / (m * m) * std::cos(m * depth); });
}

/// The largest errors over the load, and over the last settlement [-].
struct Errors {
  double pressure = 0, settlement = 0;
};

Errors follow(const Column& c, On on) {
  const Domain domain = filled(ground(8, 8, side, c.layer(), flat, {-3.5, -3.5}), {0, side, 0, side, 0, height}, 1, 2);
  const SolveOptions o = options_of(c);
  const Scene scene = make_scene(domain, o);
  const auto solver = make_solver(scene, o, on);
  const auto heights = [&] {
    const ParticleState s = solver->state().points;
    std::vector<double> z(s.size());
    const auto x = positions(scene, s);
    for (std::size_t p = 0; p < s.size(); ++p) z[static_cast<std::size_t>(s.id[p])] = x[p][2];
    return z;
  };
  const std::vector<double> first = heights();
  const std::size_t top = static_cast<std::size_t>(std::ranges::max_element(first) - first.begin());
  Errors worst;
  for (const double t : {0.05, 0.1, 0.2, 0.5, 1.0}) {
    run_to(*solver, c.time_of(t));
    const ParticleState s = solver->state().points;
    double off = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      const double z = first[static_cast<std::size_t>(s.id[p])];
      if (z > height - c.layer() / 2) continue;  // there the load comes in
      const double buoyant = (o.material.density - o.water.fluid_density) * pull * (height - z);
      const double excess = load + buoyant - s.effective_stress[p];
      const double depth = c.both_ways ? 1 - std::abs(1 - (height - z) / c.path()) : (height - z) / c.path();
      off = std::max(off, std::abs(excess / load - excess_at(depth, t)));
    }
    const double deep = (height - first[top]) / c.path(), whole = c.both_ways ? 2 : 1;
    const double wanted = settlement_at(deep, t) + (whole - 1) * settlement_at(0, t);
    const double undrained = load / o.material.youngs_modulus;
    const double strain =
        (first[top] - heights()[top]) / c.path() / (load / modulus) - undrained * whole / (load / modulus);
    worst.pressure = std::max(worst.pressure, off);
    worst.settlement = std::max(worst.settlement, std::abs(strain - wanted) / whole);
  }
  return worst;
}

class Consolidation : public InEachPlace {};

TEST_P(Consolidation, is_terzaghis) {
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit, Integrator::quasi_static}) {
    const Errors one = follow({integrator, 16, false}, GetParam());
    EXPECT_LT(one.pressure, 0.01) << name_of(integrator);
    EXPECT_LT(one.settlement, 0.005) << name_of(integrator);
  }
}

TEST_P(Consolidation, is_terzaghis_by_both_ways) {
  const Errors found = follow({Integrator::column_implicit, 32, true}, GetParam());
  EXPECT_LT(found.pressure, 0.01);
  EXPECT_LT(found.settlement, 0.01);
}

TEST_P(Consolidation, converges_with_the_square_of_the_layers) {
  const Errors coarse = follow({Integrator::column_implicit, 8, false}, GetParam()),
               fine = follow({Integrator::column_implicit, 16, false}, GetParam());
  EXPECT_LT(fine.pressure, coarse.pressure / 2.5) << fine.pressure << " of " << coarse.pressure;
}

TALUS_IN_EACH_PLACE(Consolidation);

}  // namespace
}  // namespace talus::solver::testing
