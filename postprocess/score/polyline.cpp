// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/polyline.hpp"

#include <algorithm>
#include <cmath>

namespace talus::postprocess {
namespace {

double apart(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

bool turns_back(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) <= 0;
}

}  // namespace

std::vector<double> lengths_along(const Polyline& line) {
  std::vector<double> lengths(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) lengths[i] = lengths[i - 1] + apart(line[i - 1], line[i]);
  return lengths;
}

Polyline resampled(const Polyline& line, double step) {
  if (line.size() < 2) return line;
  const auto lengths = lengths_along(line);
  const int steps = std::max(1, static_cast<int>(std::lround(lengths.back() / step)));
  Polyline even{line.front()};
  std::size_t segment = 1;
  for (int k = 1; k < steps; ++k) {
    const double place = lengths.back() * k / steps;
    while (segment + 1 < line.size() && lengths[segment] < place) ++segment;
    const double span = lengths[segment] - lengths[segment - 1];
    const double part = span > 0 ? (place - lengths[segment - 1]) / span : 0;
    const auto &a = line[segment - 1], &b = line[segment];
    even.push_back({a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])});
  }
  even.push_back(line.back());
  return even;
}

Polyline smoothed(Polyline line, int times) {
  for (int k = 0; k < times; ++k) {
    const Polyline before = line;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      for (std::size_t c = 0; c < 2; ++c)
        line[i][c] = 0.25 * before[i - 1][c] + 0.5 * before[i][c] + 0.25 * before[i + 1][c];
    }
  }
  return line;
}

Polyline without_returns(const Polyline& line, double step) {
  Polyline kept;
  for (const auto& point : line) {
    if (!kept.empty() && apart(kept.back(), point) < step) continue;
    if (kept.size() > 1 && turns_back(kept[kept.size() - 2], kept.back(), point)) continue;
    kept.push_back(point);
  }
  if (line.size() < 2 || kept.back() == line.back()) return kept;
  // The last point must stay: what stands in its way goes.
  while (kept.size() > 1 &&
         (apart(kept.back(), line.back()) < step || turns_back(kept[kept.size() - 2], kept.back(), line.back()))) {
    kept.pop_back();
  }
  kept.push_back(line.back());
  return kept;
}

}  // namespace talus::postprocess
