// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B1 and B2: blocks on an incline.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

/// The CFL step of a block of B1 and B2 on 30 degrees: waves of 775 m/s across cells of a metre [s].
constexpr double wave_step_of_the_block = 7.07e-4;

struct Incline {
  double angle, direction, friction;  // [deg]; direction of descent from east
  int layers;                         // thickness in cells
};

Overrides overrides_of(const Incline& c) {
  const double slope = std::tan(c.angle * degree), x = std::cos(c.direction * degree),
               y = std::sin(c.direction * degree);
  const double west = std::floor(27 - 14 * x), south = std::floor(27 - 14 * y);  // 6 m square, uphill of the middle
  return {{"preprocess.laboratory.slope[0]", -slope * x},
          {"preprocess.laboratory.slope[1]", -slope * y},
          {"preprocess.box[0].extent_m[0]", west},
          {"preprocess.box[0].extent_m[2]", west + 6},
          {"preprocess.box[0].extent_m[1]", south},
          {"preprocess.box[0].extent_m[3]", south + 6},
          {"preprocess.box[0].extent_m[5]", static_cast<double>(c.layers)},
          {"solve.base.friction_angle_deg", c.friction}};
}

/// Explicit steps on the terrain-following grid, and with the long runs the Cartesian one and column-implicit steps.
struct BlockVariant {
  const char* words;
  Overrides overrides;
};
std::vector<BlockVariant> block_variants(const Bench& bench) {
  std::vector<BlockVariant> list{{"", {}}};
  if (bench.complete()) {
    const Overrides cartesian{{"solve.mapping", words("cartesian")}},
        columns{{"solve.integrator", words("column-implicit")}};
    list.push_back({", cartesian", cartesian});
    list.push_back({", column-implicit", columns});
    list.push_back({", cartesian, column-implicit", cartesian + columns});
  }
  return list;
}

/// Planimetric way of the centre between two frames; NaN when points were lost.
double way_between(const Points& a, const Points& b) {
  double x = 0, y = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    x += b.position[p][0] - a.position[p][0];
    y += b.position[p][1] - a.position[p][1];
  }
  return std::hypot(x, y) / static_cast<double>(a.size());
}

double way_of(const Outcome& o) {
  return o.ok() ? way_between(o.first(), o.last()) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void block_on_incline(Bench& bench) {
  std::vector<Incline> slopes{{30, 0, 20, 4}, {30, 37, 20, 4}, {45, 60, 25, 2}, {20, 200, 5, 1}};
  if (bench.complete()) {
    for (const Incline& more :
         {Incline{30, 90, 20, 1}, Incline{30, 0, 20, 1}, Incline{45, 135, 10, 4}, Incline{25, 300, 15, 2}}) {
      slopes.push_back(more);
    }
  }
  for (const BlockVariant& variant : block_variants(bench)) {
    for (const Incline& c : slopes) {
      const Outcome o = bench.run(fmt::format("{:g} deg towards {:g}, bed {:g} deg, {} cells{}", c.angle, c.direction,
                                              c.friction, c.layers, variant.words),
                                  overrides_of(c) + variant.overrides);
      const double mu = std::tan(c.friction * degree);
      const double exact = SlidingBlock{c.angle * degree, mu, mu}.way(0, 2) * std::cos(c.angle * degree);
      // validation.md B1: 1 % at four cells, 3 % at one.
      bench.compare(o, "distance", way_of(o), exact, c.layers >= 4 ? 0.01 : c.layers >= 2 ? 0.02 : 0.03);
    }
  }
  // Less than 1e-4 of its length in 60 s, after the jolt of sudden gravity has died down; ten seconds where time is
  // short.
  const double time = bench.complete() ? 60 : 10;
  const Outcome still = bench.run(fmt::format("25 deg, bed 30 deg: at rest for {:g} s", time),
                                  overrides_of({25, 30, 30, 2}) + Overrides{{"solve.material.youngs_modulus_Pa", 1e7},
                                                                            {"solve.end_time_s", time + 1}});
  if (still.ok()) {
    bench.measure(still, fmt::format("creep over length in {:g} s", time),
                  way_between(still.frames.at(1), still.last()) / 6, 1e-4 * time / 60);
  } else {
    bench.measure(still, "creep over length", 0, 1e-4);
  }
}

void velocity_weakening(Bench& bench) {
  for (const BlockVariant& variant : block_variants(bench)) {
    const Outcome o = bench.run(std::string("30 deg, mu 0.5 to 0.2") + variant.words, variant.overrides);
    const double exact = SlidingBlock{30 * degree, 0.5, 0.2, 2}.way(1, 2) * std::cos(30 * degree);
    bench.compare(o, "distance", way_of(o), exact, 0.01);
  }
  // Newmark's trapezoid meets the law at the end of a step, however long; steps of 14 CFL alone where time is short.
  for (const double steps : bench.complete() ? std::vector<double>{1, 4, 9, 14} : std::vector<double>{14}) {
    const Outcome o =
        bench.run(fmt::format("30 deg, mu 0.5 to 0.2, newmark, {:g} CFL", steps),
                  {{"solve.integrator", words("newmark")}, {"solve.implicit.step_s", steps * wave_step_of_the_block}});
    const double exact = SlidingBlock{30 * degree, 0.5, 0.2, 2}.way(1, 2) * std::cos(30 * degree);
    bench.compare(o, "distance", way_of(o), exact, 0.001);
  }
}

}  // namespace talus::validation
