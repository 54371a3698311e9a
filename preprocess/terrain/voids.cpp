// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/voids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/terrain/triangulation.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr int most_trials = 8;
constexpr std::size_t enough_cells = 200;  // of a trial hole: more would not change the estimate
const double unknown = nan;

using Hole = std::vector<Cell>;

/// Voids that do not reach the edge, in the order of their cells.
std::vector<Hole> holes_of(const Raster& raster) {
  const MapGrid& grid = raster.grid;
  std::vector<char> marked(grid.count());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = std::isnan(raster.values[i]);
  const std::vector<char> outside = reaching_edge(grid, marked);
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = marked[i] && !outside[i];
  std::vector<Hole> holes;
  each_cell(grid, [&](int column, int row) {
    if (marked[grid.index(column, row)]) holes.push_back(take_connected(grid, marked, {Cell{column, row}}));
  });
  return holes;
}

/// Cells with data that touch the hole.
Hole rim_of(const Raster& raster, const Hole& hole) {
  Hole rim;
  for (const Cell& cell : hole) {
    each_near(raster.grid, cell, 1, [&](int c, int r) {
      if (!std::isnan(raster.at(c, r))) rim.push_back({c, r});
    });
  }
  std::ranges::sort(rim);
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  return rim;
}

/// From every cell of a hole to the nearest with data [cells].
std::vector<double> distances(const Raster& raster, const Hole& hole) {
  const Hole rim = rim_of(raster, hole);
  std::vector<double> result;
  for (const auto& [column, row] : hole) {
    int least = std::numeric_limits<int>::max();
    for (const auto& [c, r] : rim) least = std::min(least, (c - column) * (c - column) + (r - row) * (r - row));
    result.push_back(std::sqrt(static_cast<double>(least)));
  }
  return result;
}

/// True when a hole would lie, with its rim, on cells that have a value.
bool on_data(const Raster& raster, const Hole& hole) {
  return std::ranges::all_of(hole, [&](const Cell& cell) {
    for (int r = cell[1] - 1; r <= cell[1] + 1; ++r) {
      for (int c = cell[0] - 1; c <= cell[0] + 1; ++c)
        if (!raster.grid.holds(c, r) || std::isnan(raster.at(c, r))) return false;
    }
    return true;
  });
}

/// Holes of the same shape beside this one, on data: the nearest, in eight directions.
std::vector<Hole> trial_holes(const Raster& raster, const Hole& hole) {
  Cell low = hole.front(), high = hole.front();
  for (const auto& [column, row] : hole) {
    low = {std::min(low[0], column), std::min(low[1], row)};
    high = {std::max(high[0], column), std::max(high[1], row)};
  }
  const int width = high[0] - low[0] + 3, height = high[1] - low[1] + 3;
  constexpr int farthest = 6;  // times the hole's own size: further away is other ground
  std::vector<Hole> trials;
  for (int k = 1; k <= farthest; ++k) {
    for (int v = -1; v <= 1; ++v) {
      for (int u = -1; u <= 1; ++u) {
        if ((u == 0 && v == 0) || trials.size() >= most_trials) continue;
        Hole trial = hole;
        for (auto& [column, row] : trial) column += u * k * width, row += v * k * height;
        if (on_data(raster, trial)) trials.push_back(std::move(trial));
      }
    }
  }
  return trials;
}

/// What filling is worth, found where the truth is known: root mean square, over some cells of every trial, of the
/// error per cell of distance to data, and of the error itself.
struct Worth {
  double rmse = unknown, per_distance = unknown;
  int trials = 0;
};

Worth worth_of(const Raster& raster, const Hole& hole, const std::vector<double>& distance) {
  const std::size_t stride = std::max<std::size_t>(1, hole.size() / enough_cells);
  double squares = 0, distances_squared = 0;
  std::size_t count = 0;
  Worth worth;
  for (const Hole& trial : trial_holes(raster, hole)) {
    Hole some;
    for (std::size_t i = 0; i < trial.size(); i += stride) some.push_back(trial[i]);
    const std::vector<double> heights = fill_hole(raster, trial, some);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (std::isnan(heights[i])) continue;
      squares += std::pow(heights[i] - raster.at(some[i][0], some[i][1]), 2);
      distances_squared += std::pow(distance[i * stride], 2);
      ++count;
    }
    ++worth.trials;
  }
  if (count == 0) return worth;
  worth.rmse = std::sqrt(squares / static_cast<double>(count));
  worth.per_distance = std::sqrt(squares / distances_squared);
  return worth;
}

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
  if (column < 1 || row < 1 || column >= raster.grid.columns - 1 || row >= raster.grid.rows - 1) return nan;
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
  if (pairs < 2) return nan;
  std::ranges::sort(heights);
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

/// The second largest deviation among the eight neighbours: large on a summit or crest, small beside one or two spikes.
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
    raster.values[candidate.cell] = nan;
  }
  return outliers;
}

}  // namespace

std::size_t Filled::count() const { return static_cast<std::size_t>(std::count(filled.begin(), filled.end(), 1)); }

double Filled::rmse() const {
  double squares = 0, cells = 0;
  for (const VoidFill& fill : voids) {
    if (!fill.filled || std::isnan(fill.rmse)) continue;
    squares += fill.rmse * fill.rmse * static_cast<double>(fill.cells);
    cells += static_cast<double>(fill.cells);
  }
  return cells > 0 ? std::sqrt(squares / cells) : unknown;
}

Filled fill_voids(Raster raster, double largest_m2) {
  const MapGrid grid = raster.grid;
  Filled result{std::move(raster), std::vector<char>(grid.count(), 0), std::vector<double>(grid.count(), 0.0), {}};
  const Raster given = result.raster;  // holes are filled from data alone, not from one another
  for (const Hole& hole : holes_of(given)) {
    VoidFill& fill = result.voids.emplace_back();
    fill.cells = hole.size();
    fill.x = grid.x(hole.front()[0]);
    fill.y = grid.y(hole.front()[1]);
    fill.area_m2 = static_cast<double>(hole.size()) * grid.cell * grid.cell;
    fill.rmse = unknown;
    if (fill.area_m2 > largest_m2 * (1 + 1e-9)) continue;
    const std::vector<double> distance = distances(given, hole);
    const auto farthest = std::max_element(distance.begin(), distance.end());
    const Cell& deepest = hole[static_cast<std::size_t>(farthest - distance.begin())];
    fill.x = grid.x(deepest[0]);
    fill.y = grid.y(deepest[1]);
    fill.largest_distance = *farthest * grid.cell;
    const std::vector<double> heights = fill_hole(given, hole, hole);
    if (std::ranges::any_of(heights, [](double z) { return std::isnan(z); })) continue;
    const Worth worth = worth_of(given, hole, distance);
    fill.filled = true;
    fill.rmse = worth.rmse;
    fill.trials = worth.trials;
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const std::size_t cell = grid.index(hole[i][0], hole[i][1]);
      result.raster.values[cell] = heights[i];
      result.filled[cell] = 1;
      result.sigma[cell] = worth.per_distance * distance[i];
    }
  }
  return result;
}

std::string summary(const Filled& filled) {
  std::size_t count = 0, largest = 0;
  double farthest = 0;
  for (const VoidFill& fill : filled.voids) {
    if (!fill.filled) continue;
    ++count;
    largest = std::max(largest, fill.cells);
    farthest = std::max(farthest, fill.largest_distance);
  }
  if (count == 0) return "";
  const double rmse = filled.rmse();
  const std::string error =
      std::isnan(rmse) ? "no place beside them to measure the error by"
                       : fmt::format("error about {:.2g} m, by filling holes of the same shape beside them", rmse);
  return fmt::format(
      "{} void{} of {} cells filled by natural neighbours (the largest {} cells; at most {:.0f} m from data; {})",
      count, count == 1 ? "" : "s", grouped(static_cast<double>(filled.count())), grouped(static_cast<double>(largest)),
      farthest, error);
}

std::vector<Outlier> spikes_and_pits(const Raster& raster, double minimum_m) {
  const MapGrid& grid = raster.grid;
  Raster deviations{grid, std::vector<double>(grid.count(), nan)};
  each_cell(grid, [&](int column, int row) {
    if (!std::isnan(raster.at(column, row))) deviations.at(column, row) = deviation(raster, column, row);
  });
  const double least = std::max(minimum_m, cells_high * grid.cell);
  std::vector<Outlier> candidates;
  each_cell(grid, [&](int column, int row) {
    const double height = deviations.at(column, row);
    if (stands_out(height, deviations, column, row, least)) candidates.push_back({grid.index(column, row), height});
  });
  std::ranges::sort(candidates,
                    [](const Outlier& a, const Outlier& b) { return std::abs(a.height) > std::abs(b.height); });
  return without_shadows(raster, candidates, deviations, least);
}

std::string summary(const std::vector<Outlier>& outliers, const MapGrid& grid) {
  if (outliers.empty()) return "";
  const auto spikes = std::ranges::count_if(outliers, [](const Outlier& o) { return o.height > 0; });
  const auto pits = static_cast<std::ptrdiff_t>(outliers.size()) - spikes;
  std::string text = fmt::format("{} spike{} and {} pit{} stand out from their neighbours: ", spikes,
                                 spikes == 1 ? "" : "s", pits, pits == 1 ? "" : "s");
  constexpr std::size_t named = 3;
  for (std::size_t i = 0; i < std::min(named, outliers.size()); ++i)
    text += fmt::format("{}{:+.1f} m at {}", i == 0 ? "" : "; ", outliers[i].height, place_of(grid, outliers[i].cell));
  return outliers.size() > named ? text + "; ..." : text;
}

}  // namespace talus::preprocess
