// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/voids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/map/sum.hpp"
#include "preprocess/terrain/hole_filler.hpp"
#include "preprocess/terrain/surfaces.hpp"

namespace talus::preprocess {

namespace {

constexpr int most_trials = 8;
constexpr std::size_t enough_cells = 200;  // of a trial hole: more would not change the estimate
const double unknown = std::numeric_limits<double>::quiet_NaN();

using Hole = std::vector<Cell>;

/// The marked cells that hang together with one; they are unmarked.
Hole take_hole(const MapGrid& grid, std::vector<char>& marked, Cell seed) {
  Hole hole{seed};
  marked[grid.index(seed[0], seed[1])] = 0;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    each_near(grid, Cell(hole[i]), 1, [&](int c, int r) {  // a copy: the hole grows
      if (!marked[grid.index(c, r)]) return;
      marked[grid.index(c, r)] = 0;
      hole.push_back({c, r});
    });
  }
  return hole;
}

/// Voids that do not reach the edge, in the order of their cells.
std::vector<Hole> holes_of(const Raster& raster) {
  const MapGrid& grid = raster.grid;
  std::vector<char> marked(grid.count());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = std::isnan(raster.values[i]);
  const std::vector<char> outside = reaching_edge(grid, marked);
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = marked[i] && !outside[i];
  std::vector<Hole> holes;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (marked[grid.index(column, row)]) holes.push_back(take_hole(grid, marked, {column, row}));
    }
  }
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
  std::sort(rim.begin(), rim.end());
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

Hole moved(const Hole& hole, int columns, int rows) {
  Hole result = hole;
  for (auto& [column, row] : result) column += columns, row += rows;
  return result;
}

/// True when a hole would lie, with its rim, on cells that have a value.
bool on_data(const Raster& raster, const Hole& hole) {
  return std::all_of(hole.begin(), hole.end(), [&](const Cell& cell) {
    for (int r = cell[1] - 1; r <= cell[1] + 1; ++r) {
      for (int c = cell[0] - 1; c <= cell[0] + 1; ++c) {
        if (!raster.grid.holds(c, r) || std::isnan(raster.at(c, r))) return false;
      }
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
        Hole trial = moved(hole, u * k * width, v * k * height);
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

VoidFill described(const MapGrid& grid, const Hole& hole) {
  VoidFill fill;
  fill.cells = hole.size();
  fill.x = grid.x(hole.front()[0]);
  fill.y = grid.y(hole.front()[1]);
  fill.area_m2 = static_cast<double>(hole.size()) * grid.cell * grid.cell;
  fill.rmse = unknown;
  return fill;
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
    VoidFill& fill = result.voids.emplace_back(described(grid, hole));
    if (fill.area_m2 > largest_m2 * (1 + 1e-9)) continue;
    const std::vector<double> distance = distances(given, hole);
    const auto farthest = std::max_element(distance.begin(), distance.end());
    const Cell& deepest = hole[static_cast<std::size_t>(farthest - distance.begin())];
    fill.x = grid.x(deepest[0]);
    fill.y = grid.y(deepest[1]);
    fill.largest_distance = *farthest * grid.cell;
    const std::vector<double> heights = fill_hole(given, hole, hole);
    if (std::any_of(heights.begin(), heights.end(), [](double z) { return std::isnan(z); })) continue;
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

}  // namespace talus::preprocess
