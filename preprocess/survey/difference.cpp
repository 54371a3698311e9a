#include "preprocess/survey/difference.hpp"

#include <algorithm>
#include <cmath>

#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {

namespace {

constexpr int block_cells = 1024;

/// Rise per metre at a cell of a raster one cell wider on every side, by differences to the neighbours there are.
double slope_at(const Raster& wide, int column, int row) {
  const auto along = [&](double behind, double ahead) {
    const double here = wide.at(column, row);
    if (!std::isnan(behind) && !std::isnan(ahead)) return (ahead - behind) / (2 * wide.grid.cell);
    if (!std::isnan(ahead)) return (ahead - here) / wide.grid.cell;
    return std::isnan(behind) ? 0.0 : (here - behind) / wide.grid.cell;
  };
  return std::hypot(along(wide.at(column - 1, row), wide.at(column + 1, row)), along(wide.at(column, row - 1), wide.at(column, row + 1)));
}

Block block_of(const Elevation& before, const Elevation& after, const MapGrid& part, const ErrorModel& model) {
  const Raster wide = onto_grid(before, cut(part, {-1, -1, part.columns + 2, part.rows + 2}));  // so that blocks do not show in the slopes
  Block block{cut(wide, {1, 1, part.columns, part.rows}), onto_grid(after, part), {part, std::vector<double>(part.count())}, {part, std::vector<double>(part.count())}};
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.columns; ++column) {
      const double d = block.after.at(column, row) - block.before.at(column, row);
      block.difference.at(column, row) = d;
      block.sigma.at(column, row) = std::isnan(d) ? d : model.sigma(slope_at(wide, column + 1, row + 1));
    }
  }
  return block;
}

}  // namespace

double Detection::level(double sigma) const {
  switch (threshold) {
    case Threshold::minimum_level: return minimum_level;
    case Threshold::propagated_error: return std::max(minimum_level, sigma);
    case Threshold::probabilistic: break;
  }
  return std::max(minimum_level, quantile * sigma);
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

void for_each_block(const Elevation& before, const Elevation& after, const MapGrid& grid, const ErrorModel& model, const std::function<void(const Block&)>& visit) {
  for (int row = 0; row < grid.rows; row += block_cells) {
    for (int column = 0; column < grid.columns; column += block_cells) {
      const CellWindow window{column, row, std::min(block_cells, grid.columns - column), std::min(block_cells, grid.rows - row)};
      visit(block_of(before, after, cut(grid, window), model));
    }
  }
}

}  // namespace talus::preprocess
