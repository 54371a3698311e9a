// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/shaking_words.hpp"

#include <fmt/format.h>

namespace talus::solver {

std::string shaking_words(const Shaking& shaking) {
  const double begin = shaking.samples.front().time;
  return fmt::format("{} samples from {:g} to {:g} s, up to {:.3g} m/s2 and {:.3g} m/s", shaking.samples.size(), begin,
                     shaking.end(), shaking.peak_acceleration(), shaking.peak_velocity());
}

std::vector<std::string> shaking_warnings(const Shaking& shaking, const SolveOptions& o) {
  std::vector<std::string> lines;
  if (!shaking.acts()) return lines;
  if (o.end_time < shaking.end())
    lines.push_back(fmt::format(
        "[solve.shaking] the run ends at {:g} s and the accelerogram at {:g} s: its last {:g} s do not act. "
        "Give end_time_s = {:g} or more",
        o.end_time, shaking.end(), shaking.end() - o.end_time, shaking.end()));
  const double last = length(shaking.samples.back().velocity), most = shaking.peak_velocity();
  if (last > most_final_velocity * most)
    lines.push_back(fmt::format(
        "[solve.shaking] at the end of the accelerogram the ground still moves at {:.3g} m/s, {:.0f} % of its "
        "largest velocity, and goes on so: the mass has got that much more than from ground that comes to "
        "rest. Correct the record's baseline, unless it is meant so",
        last, 100 * last / most));
  return lines;
}

}  // namespace talus::solver
