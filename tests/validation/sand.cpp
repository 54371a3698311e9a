// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/sand.hpp"

#include <algorithm>

namespace talus::validation {
namespace {

/// The thickness of a deposit at x, between the places of an outline [m]; 0 beyond it.
double thickness_at(const Series& outline, double x) {
  for (std::size_t n = 1; n < outline.x.size(); ++n) {
    if (x > outline.x[n]) continue;
    const double share = (x - outline.x[n - 1]) / (outline.x[n] - outline.x[n - 1]);
    return outline.y[n - 1] + share * (outline.y[n] - outline.y[n - 1]);
  }
  return 0;
}

}  // namespace

double top_of(const Points& points, const Sand& s) {
  double top = 0;
  for (const auto& p : points.position)
    if (std::isfinite(p[2])) top = std::max(top, p[2]);
  return top + 0.5 * s.point_spacing();
}

Series outline_of(const Outcome& o, std::size_t frame, const Sand& s, int colour) {
  const MapGrid& grid = o.run.maps.grid;
  const auto column_at = [&](int column) {
    double sum = 0;
    for (int row = 0; column >= 0 && row < grid.rows; ++row) {
      const double t = o.run.frames.thickness.at(frame)[grid.index(column, row)];
      if (std::isfinite(t)) sum += t;
    }
    return sum;
  };
  const int wall = static_cast<int>(std::lround(-grid.west / s.h - 0.5));
  const auto thickness = [&](int column) {
    column = std::abs(column - wall) + wall;
    return column_at(column) + column_at(2 * wall - column);
  };
  Series outline{"", {}, {}, colour};
  for (int column = wall; column + 1 < grid.columns; ++column) {
    outline.add(grid.x(column), (thickness(column - 1) + thickness(column) + thickness(column + 1)) / 3);
    if (outline.y.back() == 0) break;
  }
  return outline;
}

Series outline_of_quarter(const Points& points, const Sand& s, int colour) {
  const double wide = 2 * s.h;
  std::vector<double> volume;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double radius = std::hypot(points.position[n][0], points.position[n][1]);
    if (!std::isfinite(radius)) continue;
    const auto ring = static_cast<std::size_t>(radius / wide);
    if (ring >= volume.size()) volume.resize(ring + 1);
    volume[ring] += static_cast<double>(points.volume[n]);
  }
  Series outline{"", {}, {}, colour};
  for (std::size_t ring = 0; ring < volume.size() && volume[ring] > 0; ++ring) {
    const double middle = (static_cast<double>(ring) + 0.5) * wide;
    outline.add(middle, volume[ring] / (std::numbers::pi / 2 * middle * wide));
  }
  return outline;
}

Series laboratory(const std::string& name, const Sand& s, double run_out, double height, int colour) {
  Series marks = marks_of(name, colour, 11);
  marks.x = {0, s.width * (1 + run_out)};
  marks.y = {s.width * height, 0};
  return marks;
}

std::vector<Series> channel_laboratories(const std::string& first_name, const Sand& s) {
  const double aspect = s.height / s.width;
  return {laboratory(first_name, s, lube_run_out(aspect), lube_height(aspect), 1),
          laboratory("Lajeunesse et al. 2005", s, lajeunesse_run_out(aspect), lajeunesse_height(aspect), 3)};
}

double profile_difference(const Series& coarse, const Series& fine) {
  if (coarse.x.empty() || fine.x.empty()) return nothing;
  constexpr int places = 400;
  const double reach = std::max(coarse.x.back(), fine.x.back());
  double sum = 0;
  for (int n = 0; n < places; ++n) {
    const double x = reach * (n + 0.5) / places, d = thickness_at(coarse, x) - thickness_at(fine, x);
    sum += d * d;
  }
  return std::sqrt(sum / places) / *std::max_element(fine.y.begin(), fine.y.end());
}

Collapse collapse(Bench& bench, const std::string& name, const Sand& s, const Overrides& more) {
  Collapse c{bench.run(name, overrides_of(s) + more)};
  if (c.outcome.ok()) {
    c.front = front_of(c.outcome.last(), s);
    c.top = top_of(c.outcome.last(), s);
  }
  const double aspect = s.height / s.width;
  const Band run_out = band_of(lube_run_out(aspect), lajeunesse_run_out(aspect)),
             height = band_of(lube_height(aspect), lajeunesse_height(aspect));
  bench.within(c.outcome, "run-out over width", c.front / s.width - 1, run_out);
  bench.within(c.outcome, "height over width", c.top / s.width, height);
  return c;
}

}  // namespace talus::validation
