// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/mobility.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"
#include "common/run/point_frames.hpp"

namespace talus {

Motion read_motion(const std::filesystem::path& run_file, double faster_than) {
  const PointFrames frames(run_file);
  Motion motion{.time = frames.time(), .volume = {}, .mean_speed = {}};
  for (std::size_t frame = 0; frame < motion.time.size(); ++frame) {
    const auto [volume, mean_speed] = frames.moving(frame, faster_than);
    motion.volume.push_back(volume);
    motion.mean_speed.push_back(mean_speed);
  }
  return motion;
}

double covering_thickness(std::vector<double> release) {
  constexpr double usual = 0.1, share = 0.05;  // [m], of the median
  std::erase_if(release, [](double h) { return !(h > 0); });
  const double least = share * median(release);  // NaN where nothing is released
  if (!(least < usual)) return usual;
  const double digit = std::pow(10, std::floor(std::log10(least)) - 1);
  return std::round(least / digit) * digit;
}

double release_limit(const RunMaps& maps, double threshold) {
  double thickest = 0;
  for (const double h : maps.initial_thickness)
    if (h > thickest) thickest = h;
  return std::min(threshold, 0.1 * thickest);
}

namespace {

constexpr double level = 1e-3;  // [m] heights that differ by less are the same

/// Of several places the one nearest to their centroid.
Place nearest_to_middle(const std::vector<Place>& places) {
  Place middle;
  for (const Place& p : places) {
    middle.x += p.x / static_cast<double>(places.size());
    middle.y += p.y / static_cast<double>(places.size());
  }
  return *std::min_element(places.begin(), places.end(), [&](const Place& a, const Place& b) {
    return plan_distance(a, middle) < plan_distance(b, middle);
  });
}

}  // namespace

std::optional<Place> crown(const RunMaps& maps, double threshold) {
  const double limit = release_limit(maps, threshold);
  std::vector<Place> highest;
  for (int row = 0; row < maps.grid.rows; ++row)
    for (int column = 0; column < maps.grid.columns; ++column) {
      const auto i = maps.grid.index(column, row);
      if (!(maps.initial_thickness[i] > limit) || std::isnan(maps.before[i])) continue;
      if (!highest.empty() && maps.before[i] < highest.front().z - level) continue;
      if (!highest.empty() && maps.before[i] > highest.front().z + level) highest.clear();
      highest.push_back({maps.grid.x(column), maps.grid.y(row), maps.before[i]});
    }
  if (highest.empty()) return std::nullopt;
  return nearest_to_middle(highest);
}

std::optional<Place> farthest(const MapGrid& grid, const std::vector<double>& values, double threshold,
                              const Place& from, const std::vector<double>& surface) {
  std::optional<Place> place;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = grid.index(column, row);
      if (!(values[i] > threshold)) continue;
      const Place here{grid.x(column), grid.y(row), surface.empty() ? 0 : surface[i]};
      if (!place || plan_distance(here, from) > plan_distance(*place, from)) place = here;
    }
  return place;
}

double plan_distance(const Place& a, const Place& b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::optional<Place> centre_of_mass(const MapGrid& grid, const std::vector<double>& thickness,
                                    const std::vector<double>& bed) {
  Place sum;
  double mass = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = grid.index(column, row);
      const double h = thickness[i];
      const double z = bed.empty() ? 0 : bed[i] + 0.5 * h;
      if (!(h > 0) || std::isnan(z)) continue;
      sum.x += h * grid.x(column);
      sum.y += h * grid.y(row);
      sum.z += h * z;
      mass += h;
    }
  if (!(mass > 0)) return std::nullopt;
  return Place{sum.x / mass, sum.y / mass, sum.z / mass};
}

}  // namespace talus
