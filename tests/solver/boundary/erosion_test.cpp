// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground that is eroded by rate: it rests until the flow has taken so much of it, and what is taken follows the law.
#include "solver/boundary/erosion.hpp"

#include <cmath>
#include <map>
#include <numeric>

#include "solver/run/recorders/history.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double slope = 30, depth = 2, from = 20, to = 56, rate = 0.1;  // [deg], of ground [m], where it lies, [1/m]

/// A slide 2 m thick that comes down on ground between `from` and `to`.
Domain slide_on_ground() {
  const double fall = std::tan(slope * degree);
  Domain d = ground(80, 16, 1, 0.5, [&](double x, double) { return -fall * x; }, {0, -8});
  fill(d, {from, to, -6, 6, 0, depth});
  const std::size_t sheet = d.points.size();
  fill(d, {from + 4, from + 14, -2, 2, depth, depth + 2});
  std::fill(d.points.release.begin() + static_cast<std::ptrdiff_t>(sheet), d.points.release.end(), 1);
  d.release_names = {"ground", "slide"};
  d.erodible = 1;
  return d;
}

SolveOptions eroding(Integrator integrator) {
  SolveOptions o = stepping_by(integrator);
  o.material.friction_angle = 20;
  o.material.youngs_modulus = 3e6;
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 20;
  o.erosion.law = ErosionLaw::rate;
  o.erosion.rate = rate;
  return o;
}

using Places = std::map<int, std::array<double, 3>>;

/// The places of the points of the ground by their id.
Places ground_of(const Scene& scene, const ParticleState& points) {
  const auto x = positions(scene, points);
  Places places;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.release[p] == 0) places[points.id[p]] = {x[p][0], x[p][1], x[p][2]};
  return places;
}

/// The least depth of ground that is left in the columns about a place.
double least_about(const Scene& scene, const std::vector<double>& left, const std::array<double, 3>& place) {
  double least = depth;
  for (const double aside : {-1, 0, 1}) {
    const auto [xi, eta] = in_cells(scene.map, place[0] + aside, place[1]);
    const auto column = scene.map.index(static_cast<int>(std::lround(xi)), static_cast<int>(std::lround(eta)));
    least = std::min(least, left[column]);
  }
  return least;
}

class Erosion : public InEachPlace {};

TEST_P(Erosion, takes_what_the_rate_says_and_leaves_the_rest_at_rest) {
  for (const Integrator integrator : flow_integrators) {
    SCOPED_TRACE(name_of(integrator));
    const SolveOptions o = eroding(integrator);
    const Scene scene = make_scene(slide_on_ground(), o);
    const auto solver = make_solver(scene, o, GetParam());
    const SolverState first = solver->state();
    // E times the integral of thickness times speed over ground and time is E / rho times that of the momentum, but for
    // what of it is finer than the grid.
    double expected = 0, before = 0;
    for (int n = 1; n <= 70; ++n) {
      run_to(*solver, 0.05 * n);
      const Vec3<double> p = solver->energies().momentum;
      const double now = std::hypot(p.x, p.y, p.z) / o.material.density;
      expected += rate * 0.05 * (before + now) / 2;
      before = now;
    }
    const SolverState end = solver->state();
    const std::vector<double>&full = first.maps.ground, &left = end.maps.ground;
    const double taken =
        std::transform_reduce(full.begin(), full.end(), left.begin(), 0.0, std::plus<>(), std::minus<>());
    EXPECT_GT(taken, 10);
    EXPECT_NEAR(taken, expected, 0.05 * expected);
    const Places start = ground_of(scene, first.points);
    int gone = 0;
    for (const auto& [id, place] : ground_of(scene, end.points)) {
      const auto& was = start.at(id);
      const double way = place[0] - was[0], height = was[2] + std::tan(slope * degree) * was[0];
      const bool inside = was[0] > from + 2 && was[0] < to - 2 && std::abs(was[1]) < 4;  // nodes beside it are free
      const bool held = inside && height < least_about(scene, left, was) - 0.75;
      EXPECT_TRUE(!held || std::abs(way) < 1e-6) << was[0] << ' ' << height << ' ' << way;
      if (way > 0.25) ++gone;
    }
    const double released = gone * first.points.volume[0];
    EXPECT_GT(released, taken / 3);
    EXPECT_LT(released, taken);
  }
}

TEST_P(Erosion, leaves_wet_ground_its_water_which_takes_the_load_of_what_overruns_it) {
  SolveOptions o = eroding(Integrator::column_implicit);
  o.erosion.rate = 1e-4;
  o.water.permeability = 0;
  const Scene scene = make_scene(slide_on_ground(), o);
  const auto solver = make_solver(scene, o, GetParam());
  run_to(*solver, 0.3);
  const RunningMaps<std::vector<double>> calm = solver->state().maps;
  run_to(*solver, 3.5);
  const RunningMaps<std::vector<double>> overrun = solver->state().maps;
  const auto [xi, eta] = in_cells(scene.map, from + 17, 0.5);  // beyond the slide at first
  const auto column = scene.map.index(static_cast<int>(std::lround(xi)), static_cast<int>(std::lround(eta)));
  const double weight = 9.81 * std::pow(std::cos(slope * degree), 2), own = weight * depth * o.material.density,
               borne = own - weight * depth * o.water.fluid_density;
  EXPECT_NEAR(calm.effective_stress[column], borne, 0.02 * borne);
  EXPECT_NEAR(overrun.effective_stress[column], borne, 0.02 * borne);
  const double heaviest = borne / (1 - overrun.peak_pore_pressure[column]);
  EXPECT_GT(heaviest, 1.2 * own);
}

TALUS_IN_EACH_PLACE(Erosion);

}  // namespace
}  // namespace talus::solver::testing
