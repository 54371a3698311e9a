// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Spikes and pits: cells that stand out from their neighbours more than the ground around is rough.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "preprocess/terrain/surfaces.hpp"
#include "preprocess/terrain/voids.hpp"

namespace talus::preprocess {

namespace {

constexpr int reach = 7;                // cells around that tell what is usual
constexpr double times_beside = 3;      // the second largest deviation among the neighbours
constexpr double times_usual = 10;      // NMAD
constexpr double cells_high = 0.25;     // of a cell: what a slope may do to a median of eight
constexpr double nmad_of_mad = 1.4826;  // makes the median absolute deviation of a normal distribution its sigma

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Height above the median of the neighbours that have one opposite them, so that a slope has no part in it; NaN where
/// there are fewer than two such pairs, as at the edge.
double deviation(const Raster& raster, int column, int row) {
  if (column < 1 || row < 1 || column >= raster.grid.columns - 1 || row >= raster.grid.rows - 1) return std::nan("");
  constexpr std::array<std::array<int, 2>, 4> directions{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}};
  std::array<double, 8> heights{};
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto [u, v] = directions[i];
    const double one = raster.at(column + u, row + v), opposite = raster.at(column - u, row - v);
    const bool both = !std::isnan(one + opposite);
    pairs += both;
    heights[2 * i] = both ? one : -INFINITY;  // a missing pair leaves the middle where it is
    heights[2 * i + 1] = both ? opposite : INFINITY;
  }
  if (pairs < 2) return std::nan("");
  std::sort(heights.begin(), heights.end());
  return raster.at(column, row) - 0.5 * (heights[3] + heights[4]);
}

/// NMAD of the deviations around a cell, its own left out.
double usual_around(const Raster& deviations, int column, int row) {
  std::vector<double> values;
  each_near(deviations.grid, {column, row}, reach, [&](int c, int r) {
    const double value = deviations.at(c, r);
    if ((c != column || r != row) && !std::isnan(value)) values.push_back(value);
  });
  if (values.empty()) return 0;
  const double centre = median(values);
  for (double& value : values) value = std::abs(value - centre);
  return nmad_of_mad * median(values);
}

/// The second largest deviation among the eight neighbours: large on a summit or along a crest, which are no faults,
/// and small beside a spike, or a pair of them.
double second_beside(const Raster& deviations, int column, int row) {
  double first = 0, second = 0;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = column - 1; c <= column + 1; ++c) {
      const double value = std::abs(deviations.at(c, r));
      if ((c == column && r == row) || !(value > second)) continue;
      second = std::min(first, value);
      first = std::max(first, value);
    }
  }
  return second;
}

bool stands_out(double height, const Raster& deviations, int column, int row, double least) {
  const double size = std::abs(height);
  return size > least && size > times_beside * second_beside(deviations, column, row) &&
         size > times_usual * usual_around(deviations, column, row);
}

/// Beside two pits a plain cell looks like a spike: the farthest out is taken first, and is no neighbour any more.
std::vector<Outlier> without_shadows(Raster raster, const std::vector<Outlier>& candidates, const Raster& deviations,
                                     double least) {
  std::vector<Outlier> outliers;
  for (const Outlier& candidate : candidates) {
    const auto [column, row] = raster.grid.cell_of(candidate.cell);
    const double height = deviation(raster, column, row);
    if (!stands_out(height, deviations, column, row, least)) continue;
    outliers.push_back({candidate.cell, height});
    raster.values[candidate.cell] = std::nan("");
  }
  return outliers;
}

}  // namespace

std::vector<Outlier> spikes_and_pits(const Raster& raster, double minimum_m) {
  const MapGrid& grid = raster.grid;
  Raster deviations{grid, std::vector<double>(grid.count(), std::nan(""))};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!std::isnan(raster.at(column, row))) deviations.at(column, row) = deviation(raster, column, row);
    }
  }
  const double least = std::max(minimum_m, cells_high * grid.cell);
  std::vector<Outlier> candidates;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double height = deviations.at(column, row);
      if (stands_out(height, deviations, column, row, least)) candidates.push_back({grid.index(column, row), height});
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Outlier& a, const Outlier& b) { return std::abs(a.height) > std::abs(b.height); });
  return without_shadows(raster, candidates, deviations, least);
}

std::string summary(const std::vector<Outlier>& outliers, const MapGrid& grid) {
  if (outliers.empty()) return "";
  const auto spikes = std::count_if(outliers.begin(), outliers.end(), [](const Outlier& o) { return o.height > 0; });
  const auto pits = static_cast<std::ptrdiff_t>(outliers.size()) - spikes;
  std::string text = fmt::format("{} spike{} and {} pit{} stand out from their neighbours: ", spikes,
                                 spikes == 1 ? "" : "s", pits, pits == 1 ? "" : "s");
  constexpr std::size_t named = 3;
  for (std::size_t i = 0; i < std::min(named, outliers.size()); ++i)
    text += fmt::format("{}{:+.1f} m at {}", i == 0 ? "" : "; ", outliers[i].height, place_of(grid, outliers[i].cell));
  return outliers.size() > named ? text + "; ..." : text;
}

}  // namespace talus::preprocess
