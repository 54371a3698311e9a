// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small ensemble for the tests: a heap that slides down a plane, with members that differ in keys of every kind.
#pragma once

#include "solver/ensemble/members.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// Of blocks on an incline: the incline, and the speed down it at the start [m/s].
inline constexpr double gravity = 9.81, slope = 10 * degree, start_speed = 5;

/// The heap: 512 points on a slope of 17 degrees.
inline Domain small_heap() {
  Domain d = ground(32, 16, 1.0, 1.0, [](double x, double) { return 0.3 * x; });
  fill(d, {18, 26, 4, 12, 0, 1});
  for (std::size_t p = 0; p < d.points.size(); ++p) {
    const int column = static_cast<int>(d.points.x[p]), row = static_cast<int>(d.points.y[p]);
    d.release_thickness.at(column, row) = 1;
  }
  for (std::size_t c = 0; c < d.before.values.size(); ++c) d.before.values[c] += d.release_thickness.values[c];
  return d;
}

/// The recipe of the heap; `more` are lines of [solve]. The runs of a GPU give the same bits again if `deterministic`.
inline std::string heap_recipe(const std::string& more = "", bool deterministic = true) {
  return "[scene]\nname = \"heap\"\n[solve]\nend_time_s = 2.0\nstop_kinetic_fraction = 0.01\n" +
         std::string(deterministic ? "deterministic = true\n" : "") + more +
         "[solve.material]\nyoungs_modulus_Pa = 1e6\n[solve.base]\nlaw = \"coulomb\"\nfriction_angle_deg = 12.0\n";
}

/// The recipe of a block that slides to rest on the incline, with lines of its material.
inline std::string block_recipe(const std::string& material) {
  const double across = start_speed * std::cos(slope), down = -start_speed * std::sin(slope);
  return "[solve]\nend_time_s = 3.0\nintegrator = \"column-implicit\"\ncfl = 0.5\ninitial_velocity_m_s = [" +
         std::to_string(across) + ", 0.0, " + std::to_string(down) + "]\n[solve.material]\n" + material +
         "youngs_modulus_Pa = 1e8\n[solve.base]\nlaw = \"coulomb\"\nfriction_angle_deg = 25.0\n";
}
/// The block, its lower edge at column 10.
inline Domain block_on_the_incline() {
  return filled(ground(28, 8, 1.0, 1.0, [](double x, double) { return 100 - std::tan(slope) * x; }),
                {6, 10, 2, 6, 0, 1});
}

/// Members that differ in numbers, in a law by its name, in the time of records and in the thickness of the release.
inline MemberTable small_table() {
  MemberTable table;
  table.design = "table";
  table.count = 6;
  table.columns = {{"solve.base.friction_angle_deg", {8, 10, 12, 14, 16, 18}, {}},
                   {"solve.material.friction_angle_deg", {30, 35, 30, 35, 30, 35}, {}},
                   {"solve.cfl", {0.5, 0.5, 0.4, 0.5, 0.3, 0.5}, {}},
                   {"solve.shape", {0, 1, 0, 1, 0, 0}, {"quadratic", "linear"}},
                   {"solve.precision", {0, 0, 0, 1, 0, 1}, {"double", "single"}},
                   {thickness_factor_key, {1, 0.8, 1.25, 1, 1, 1.5}, {}}};
  table.own_domain.assign(6, 0);
  return table;
}

/// The number of values that differ.
inline std::size_t differing(const std::vector<double>& a, const std::vector<double>& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n)
    if (!(a[n] == b[n] || (std::isnan(a[n]) && std::isnan(b[n])))) ++count;
  return count;
}

/// An ensemble of the heap, whose recipe lies in a scratch folder.
struct SmallEnsemble {
  test::Scratch scratch;
  recipe::Recipe recipe;
  MemberTable table;
  Domain domain = small_heap();
  SolveOptions base;
  EnsemblePaths paths;

  explicit SmallEnsemble(MemberTable members = small_table(), const std::string& more = "", bool deterministic = true)
      : recipe(scratch.write("recipe.toml", heap_recipe(more, deterministic))),
        table(std::move(members)),
        base(options_of(recipe, scratch.folder())),
        paths{scratch.folder()} {}

  Members members() const { return {recipe, table, paths, std::make_shared<const Domain>(domain), base}; }

  /// Counts of a part, in which nothing is counted yet.
  EnsembleCounts counts(const MemberRange& part) const {
    EnsembleCounts counts = empty_counts({.scene = "heap",
                                          .title = "heap",
                                          .grid = domain.grid,
                                          .terrain = domain.terrain.values,
                                          .before = domain.before.values,
                                          .release_thickness = domain.release_thickness.values,
                                          .threshold = *with_map_threshold(base, domain).map_threshold},
                                         table.count, part, {});
    counts.fingerprint = "heap";
    return counts;
  }
  EnsembleCounts counts() const { return counts({0, table.count}); }
};

}  // namespace talus::solver::testing
