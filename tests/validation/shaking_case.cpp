// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B7: a block on shaking ground.
#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "tests/common/shaken_block.hpp"
#include "tests/validation/cases.hpp"

namespace talus::validation {
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
  double way = 0;
  for (std::size_t p = 0; p < o.first().size(); ++p) way += o.last().position[p][0] - o.first().position[p][0];
  return way / static_cast<double>(o.first().size()) / std::cos(ShakenPlane::radians(plane.angle));
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

}  // namespace talus::validation
