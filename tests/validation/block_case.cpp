// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B1, B2, B7 and B8: blocks on an incline, on shaking ground and of unknown friction.
#include <algorithm>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "tests/common/shaken_block.hpp"
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
  const auto from = centre_of(a), to = centre_of(b);
  return std::hypot(to[0] - from[0], to[1] - from[1]);
}

double way_of(const Outcome& o) { return o.ok() ? way_between(o.first(), o.last()) : nothing; }

}  // namespace

void block_on_incline(Bench& bench) {
  std::vector<Incline> slopes{{30, 0, 20, 4}, {30, 37, 20, 4}, {45, 60, 25, 2}, {20, 200, 5, 1}};
  if (bench.complete()) {
    for (const Incline& more :
         {Incline{30, 90, 20, 1}, Incline{30, 0, 20, 1}, Incline{45, 135, 10, 4}, Incline{25, 300, 15, 2}})
      slopes.push_back(more);
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
  // Less than 1e-4 of its length in 60 s, once the jolt of sudden gravity has died down; in 10 s where time is short.
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

namespace {

using test::GroundRecord;
using test::ShakenPlane;

/// An accelerogram, and the time at which the block rests again.
struct Shake {
  const char* name;
  GroundRecord record;
  double end;  // [s]
};

constexpr double pulse_strength = 0.5 * ShakenPlane::g, pulse_begin = 0.1, pulse_length = 0.3;

std::vector<Shake> shakes_of(const ShakenPlane& plane) {
  const double rest = plane.time_of_pulse(pulse_strength, pulse_length);
  return {{"pulse", test::pulse(pulse_strength, pulse_begin, pulse_begin + pulse_length), pulse_begin + rest + 0.1},
          {"waves", test::sine_train(4, 1.5, 3, 0.1), 2.6},
          {"irregular", test::irregular(8, 3, 0.05, 7), 3.6}};
}

/// The record as a file for the solver.
std::filesystem::path written(const Bench& bench, const Shake& shake) {
  const auto folder = bench.request().out / bench.name();
  std::filesystem::create_directories(folder);
  std::string text = "time_s,east,up\n";
  // Rows count from the first one, which acts at start_s.
  for (std::size_t n = 0; n < shake.record.time.size(); ++n)
    text += fmt::format("{:.17g},{:.17g},{:.17g}\n", shake.record.time[n], shake.record.east[n], shake.record.up[n]);
  const auto file = std::filesystem::absolute(folder / (std::string(shake.name) + ".csv"));
  write_text(file, text);
  return file;
}

Outcome shaken(Bench& bench, const ShakenPlane& plane, const Shake& shake, const char* integrator) {
  return bench.run(fmt::format("{}, {:g} deg, bed {:g} deg, {}", shake.name, plane.angle, plane.friction, integrator),
                   {{"preprocess.laboratory.slope[0]", -std::tan(ShakenPlane::radians(plane.angle))},
                    {"solve.base.friction_angle_deg", plane.friction},
                    {"solve.integrator", words(integrator)},
                    {"solve.end_time_s", shake.end},
                    {"solve.shaking.file", words(written(bench, shake).string())},
                    {"solve.shaking.start_s", shake.record.time.front()}});
}

/// Way of the block down the plane [m]; NaN where there is no result.
double way_down(const Outcome& o, const ShakenPlane& plane) {
  if (!o.ok()) return nothing;
  return (centre_of(o.last())[0] - centre_of(o.first())[0]) / std::cos(ShakenPlane::radians(plane.angle));
}

}  // namespace

void shaken_block(Bench& bench) {
  std::vector<ShakenPlane> planes{{15, 25}};
  if (bench.complete()) planes.insert(planes.end(), {{15, 22}, {25, 32}, {25, 35}});
  for (const ShakenPlane& plane : planes) {
    for (const Shake& shake : shakes_of(plane)) {
      const double rigid = shake.name == std::string("pulse") ? plane.way_of_pulse(pulse_strength, pulse_length)
                                                              : plane.way(shake.record, shake.end);
      for (const char* integrator : {"explicit", "column-implicit", "newmark"}) {
        const Outcome o = shaken(bench, plane, shake, integrator);
        bench.compare(o, "way down the plane", way_down(o, plane), rigid, 0.01);
      }
    }
  }
}

namespace {

constexpr double gravity = 9.81;                           ///< [m/s2]
constexpr double incline = 10 * degree, start_speed = 5;   ///< [rad], [m/s]
constexpr double least_friction = 20, most_friction = 30;  ///< of the bed, uniform between them [deg]

/// The plan distance in which a rigid block comes to rest [m].
double stopping_distance(double friction_deg) {
  const double deceleration = gravity * (std::tan(friction_deg * degree) * std::cos(incline) - std::sin(incline));
  return start_speed * start_speed / (2 * deceleration) * std::cos(incline);
}

/// The share of all blocks that go no farther than `distance` in plan: with more friction than one that stops there.
double share_within(double distance) {
  const double deceleration = start_speed * start_speed * std::cos(incline) / (2 * distance);
  const double tangent = (deceleration / gravity + std::sin(incline)) / std::cos(incline);
  return std::clamp((most_friction - std::atan(tangent) / degree) / (most_friction - least_friction), 0.0, 1.0);
}

/// Kolmogorov and Smirnov's distance between the distances of a sample and their distribution.
double distribution_distance(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const auto count = static_cast<double>(sample.size());
  double apart = 0;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const double share = share_within(sample[k]), below = static_cast<double>(k) / count;
    apart = std::max({apart, std::abs(share - below), std::abs(share - below - 1 / count)});
  }
  return apart;
}

}  // namespace

void blocks_of_unknown_friction(Bench& bench) {
  const long members = bench.complete() ? 10000 : bench.coarse() ? 60 : 500;
  const MembersOutcome o =
      bench.run_members(fmt::format("{} members", members), {{"ensemble.members", whole(members)}});
  std::vector<double> distances;
  double largest = 0;
  if (o.outcome.ok()) {
    const std::vector<double>& friction = o.table.columns.front().values;
    for (std::size_t k = 0; k < friction.size(); ++k) {
      if (o.counts.states[k] != MemberState::counted) continue;
      distances.push_back(o.counts.results[k].centre_travel);
      largest = std::max(largest, std::abs(distances.back() / stopping_distance(friction[k]) - 1));
    }
  }
  bench.at_least(o.outcome, "members counted", static_cast<double>(distances.size()), static_cast<double>(members));
  // Half a per cent: the block is elastic, and stops within a wave's time.
  bench.measure(o.outcome, "largest error of a distance", largest, 0.005);
  // The bound that 99 % of all samples of a distribution keep (Kolmogorov's limit law).
  bench.measure(o.outcome, "distance of the distributions", distribution_distance(distances),
                1.628 / std::sqrt(static_cast<double>(members)));
}

}  // namespace talus::validation
