// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace talus::postprocess {

double auroc(const std::vector<double>& simulated, const std::vector<double>& surveyed, double threshold) {
  std::vector<std::pair<double, bool>> cells;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    if (!std::isnan(simulated[i]) && !std::isnan(surveyed[i]))
      cells.emplace_back(simulated[i], surveyed[i] > threshold);
  }
  std::sort(cells.begin(), cells.end());
  double wins = 0, yes = 0, no = 0;
  for (std::size_t start = 0; start < cells.size();) {
    double yes_here = 0, no_here = 0;  // of one value
    std::size_t end = start;
    for (; end < cells.size() && cells[end].first == cells[start].first; ++end)
      (cells[end].second ? yes_here : no_here) += 1;
    wins += yes_here * (no + 0.5 * no_here);
    yes += yes_here;
    no += no_here;
    start = end;
  }
  return yes > 0 && no > 0 ? wins / (yes * no) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace talus::postprocess
