// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/residuals.hpp"

#include <cmath>

#include "common/map/statistics.hpp"

namespace talus::preprocess {

Residuals residuals_of(const std::vector<double>& values) {
  Residuals r{talus::median(values), talus::nmad(values), 0, 0, values.size()};
  std::vector<double> sizes;
  double squares = 0;
  for (const double v : values) {
    sizes.push_back(std::abs(v));
    squares += v * v;
  }
  r.median_absolute = talus::median(sizes);
  r.rmse = std::sqrt(squares / static_cast<double>(values.size()));
  return r;
}

}  // namespace talus::preprocess
