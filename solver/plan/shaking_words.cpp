// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/shaking_words.hpp"

#include <fmt/format.h>

#include "common/stage/findings.hpp"
namespace talus::solver {

std::string shaking_words(const Shaking& shaking) {
  const double begin = shaking.samples.front().time;
  return fmt::format("{} samples from {:g} to {:g} s, up to {:.3g} m/s2 and {:.3g} m/s", shaking.samples.size(), begin,
                     shaking.end(), shaking.peak_acceleration(), shaking.peak_velocity());
}

void warn_of_shaking(const Shaking& shaking, const SolveOptions& o) {
  if (!shaking.acts()) return;
  if (o.end_time < shaking.end())
    warn("shaking-cut-off",
         fmt::format(
             "[solve.shaking] the run ends at {:g} s and the accelerogram at {:g} s: its last {:g} s do not act. "
             "Give end_time_s = {:g} or more",
             o.end_time, shaking.end(), shaking.end() - o.end_time, shaking.end()),
         {{"end_of_shaking", shaking.end(), "s"}});
  const double last = length(shaking.samples.back().velocity), most = shaking.peak_velocity();
  if (last > most_final_velocity * most)
    warn("ground-moves-on",
         fmt::format(
             "[solve.shaking] at the end of the accelerogram the ground still moves at {:.3g} m/s, {:.0f} % of its "
             "largest velocity, and goes on so: the mass has got that much more than from ground that comes to "
             "rest. Correct the record's baseline, unless it is meant so",
             last, 100 * last / most),
         {{"final_velocity", last, "m s-1"}, {"largest_velocity", most, "m s-1"}});
}

}  // namespace talus::solver
