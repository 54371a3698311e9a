// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/progress.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/error.hpp"

namespace talus::solver {
namespace {

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

std::string progress_line(const Clock& clock, const RunProgress& progress) {
  const double done = clock.time / progress.end_time;
  return fmt::format("t {:.2f}/{:g} s  step {}  dt {:.3g} s  v_max {:.1f} m/s  mass error {:.1e}  eta {}", clock.time,
                     progress.end_time, clock.step, clock.step_size, positive_from_bits(clock.control.speed_bits),
                     progress.mass_error, done > 0 ? duration(progress.wall_time * (1 - done) / done) : "?");
}

void refuse_lost_point(const Clock& clock, const ParticleState& s, const MapGrid& map, double cfl) {
  std::string where = "unknown place";
  const auto found = std::find(s.id.begin(), s.id.end(), clock.alarms.failed_point);
  if (found != s.id.end()) {
    const auto p = static_cast<std::size_t>(found - s.id.begin());
    where = fmt::format("({:.1f}, {:.1f})", map.x(s.cell[0][p]), map.y(s.cell[1][p]));
  }
  throw NumericalError(
      {fmt::format("step {}, t = {:.4f} s: material point {} near {} lost its state (not a number, or faster "
                   "than 1000 km/s)",
                   clock.step, clock.time, clock.alarms.failed_point, where),
       fmt::format("the step of {:.3g} s is too long for it", clock.step_size),
       fmt::format("Lower cfl (now {:g}), or use shape = \"quadratic\" with transfer = \"apic\"", cfl)});
}

}  // namespace talus::solver
