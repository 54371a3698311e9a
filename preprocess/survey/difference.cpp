// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/difference.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/crop.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {

namespace {

constexpr int block_cells = 1024;

Block block_of(const Elevation& before, const Elevation& after, const MapGrid& part, const ErrorModel& model) {
  const Raster wide = onto_grid(
      before, cut(part, {-1, -1, part.columns + 2, part.rows + 2}));  // so that blocks do not show in the slopes
  const CellWindow inner{1, 1, part.columns, part.rows};
  Block block{cut(wide, inner),
              onto_grid(after, part),
              {part, std::vector<double>(part.count())},
              cut(Raster{wide.grid, model.sigmas(wide)}, inner)};
  for (std::size_t i = 0; i < part.count(); ++i) {
    const double d = block.after.values[i] - block.before.values[i];
    block.difference.values[i] = d;
    if (std::isnan(d)) block.sigma.values[i] = d;
  }
  return block;
}

}  // namespace

double level_of_detection(double sigma) {
  constexpr double quantile = 1.9599639845400534;  // of the normal distribution
  return std::max(0.0, quantile * sigma);
}

void BudgetSum::add(double difference, double sigma) {
  if (difference == 0) {
    ++level_;
    level_squares_ += sigma * sigma;
    return;
  }
  Side& side = difference < 0 ? down_ : up_;
  side.sum += std::abs(difference);
  side.squares += sigma * sigma;
  ++side.cells;
}

VolumeWithError BudgetSum::volume(const Side& side, const ErrorModel& model, double cell) {
  if (side.cells == 0) return {};
  const double count = static_cast<double>(side.cells), area = count * cell * cell;
  return {side.sum * cell * cell, area, area * model.of_mean(side.squares / count, area, cell)};
}

Budget BudgetSum::budget(const ErrorModel& model, double cell) const {
  Budget budget{volume(down_, model, cell), volume(up_, model, cell), {}};
  budget.net = volume({0, down_.squares + up_.squares + level_squares_, down_.cells + up_.cells + level_}, model, cell);
  budget.net.volume = budget.deposition.volume - budget.erosion.volume;
  return budget;
}

void for_each_block(const Elevation& before, const Elevation& after, const MapGrid& grid, const ErrorModel& model,
                    const std::function<void(const Block&)>& visit) {
  for (int row = 0; row < grid.rows; row += block_cells) {
    for (int column = 0; column < grid.columns; column += block_cells) {
      stop_if_interrupted("comparing the surveys");
      const CellWindow window{column, row, std::min(block_cells, grid.columns - column),
                              std::min(block_cells, grid.rows - row)};
      visit(block_of(before, after, cut(grid, window), model));
    }
  }
}

}  // namespace talus::preprocess
