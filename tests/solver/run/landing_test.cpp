// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lone points of any mass that fall into steep pits and land there many times: none gains energy.
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Pits with walls of 60 degrees and uneven ground, a point over each: of 0.001 to 1 of the mass that a cell holds.
struct Pits {
  static constexpr int cells = 20;
  static constexpr double steep = 1.7320508;
  Domain domain;
  std::mt19937 random{1};
  std::uniform_real_distribution<double> any{0, 1};

  explicit Pits(int across) {
    domain = ground(across * cells, across * cells, 1.0, 0.5, [](double x, double y) {
      const double a = std::fmod(x + cells, cells) - 0.5 * cells, b = std::fmod(y + cells, cells) - 0.5 * cells;
      return steep * std::max(std::abs(a), std::abs(b)) + 0.3 * std::sin(1.5 * x) * std::cos(1.3 * y);
    });
    for (int row = 1; row + 1 < across; ++row)
      for (int column = 1; column + 1 < across; ++column) add_point((column + 0.5) * cells, (row + 0.5) * cells);
  }

  /// A point near the middle of a pit.
  void add_point(double x, double y) {
    const double side = std::pow(10.0, -any(random));
    SeedPoints& p = domain.points;
    p.x.push_back(x + 6 * (any(random) - 0.5));
    p.y.push_back(y + 6 * (any(random) - 0.5));
    p.height.push_back(1 + 8 * any(random));
    p.volume.push_back(0.5 * side * side * side);
    p.extent_x.push_back(side);
    p.extent_y.push_back(side);
    p.release.push_back(0);
  }

  /// The points move in any direction, at up to 6 m/s along each axis.
  void throw_points(Scene& scene) {
    for (auto& component : scene.points.velocity)
      for (double& v : component) v = 12 * (any(random) - 0.5);
  }
};

/// Half the squared speed and g times the height of every point by its number, the mean over its parts [m2/s2].
std::vector<double> specific_energies(const Scene& scene, const ParticleState& s, std::size_t count) {
  const auto where = positions(scene, s);
  std::vector<double> energy(count), volume(count);
  for (std::size_t p = 0; p < s.size(); ++p) {
    double square = 0;
    for (const auto& component : s.velocity) square += component[p] * component[p];
    const auto id = static_cast<std::size_t>(s.id[p]);
    energy[id] += s.volume[p] * (square / 2 + 9.81 * where[p][2]);
    volume[id] += s.volume[p];
  }
  for (std::size_t id = 0; id < count; ++id) energy[id] /= volume[id];
  return energy;
}

/// What happened to the points of a run.
struct Landings {
  long count = 0;        ///< tenths of a second in which a point lost a tenth of a metre's fall or more
  double most_gain = 0;  ///< energy over that at the start, of any point [m2/s2]
};

Landings land(Pits pits, const SolveOptions& o, On on) {
  Scene scene = make_scene(pits.domain, o);
  pits.throw_points(scene);
  const std::size_t count = scene.points.size();
  const auto solver = make_solver(scene, o, on);
  const auto energies = [&] { return specific_energies(scene, solver->state().points, count); };
  const std::vector<double> start = energies();
  std::vector<double> before = start;
  Landings result;
  for (int n = 1; n <= 30; ++n) {
    run_to(*solver, 0.1 * n);
    const std::vector<double> now = energies();
    for (std::size_t p = 0; p < count; ++p) {
      if (before[p] - now[p] > 0.1 * 9.81) ++result.count;
      result.most_gain = std::max(result.most_gain, now[p] - start[p]);
    }
    before = now;
  }
  return result;
}

class Landing : public InEachPlace {};
TALUS_IN_EACH_PLACE(Landing);

/// The grid knows heights to half a cell times the slope, which halves of split points lie apart too: that height times
/// g is the most that a point can seem to gain. TALUS_PITS: pits along a side, for more (165: about a million
/// landings).
TEST_P(Landing, gives_no_lone_point_energy) {
  const char* wanted = std::getenv("TALUS_PITS");
  const int across = wanted != nullptr ? static_cast<int>(std::strtol(wanted, nullptr, 10)) : 12;
  for (const auto& [integrator, cfl, shape] : {std::tuple{Integrator::explicit_, 0.5, ShapeKind::quadratic},
                                               {Integrator::explicit_, 0.5, ShapeKind::linear},
                                               {Integrator::explicit_, 0.5, ShapeKind::gimp},
                                               {Integrator::column_implicit, 0.5, ShapeKind::quadratic},
                                               {Integrator::column_implicit, 1.5, ShapeKind::quadratic}}) {
    SolveOptions o = stepping_by(integrator);
    o.cfl = cfl;
    o.shape = shape;
    o.material.youngs_modulus = 1e6;
    o.material.density = 200;
    const Landings landings = land(Pits(across), o, GetParam());
    EXPECT_GT(landings.count, 3 * (across - 2) * (across - 2))
        << name_of(integrator) << ' ' << cfl << ' ' << static_cast<int>(shape);
    EXPECT_LT(landings.most_gain, 9.81 * Pits::steep / 2)
        << name_of(integrator) << ' ' << cfl << ' ' << static_cast<int>(shape);
  }
}

}  // namespace
}  // namespace talus::solver::testing
