#include "preprocess/survey/difference.hpp"

#include <algorithm>
#include <cmath>

#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {

namespace {

constexpr int block_cells = 1024;

/// Rise per metre at every cell, by differences to the neighbours there are.
double slope_at(const Raster& z, int column, int row) {
  const auto value = [&](int c, int r) {
    return c < 0 || r < 0 || c >= z.grid.columns || r >= z.grid.rows ? std::nan("") : z.at(c, r);
  };
  const auto along = [&](double behind, double ahead) {
    const double here = z.at(column, row);
    if (!std::isnan(behind) && !std::isnan(ahead)) return (ahead - behind) / (2 * z.grid.cell);
    if (!std::isnan(ahead)) return (ahead - here) / z.grid.cell;
    return std::isnan(behind) ? 0.0 : (here - behind) / z.grid.cell;
  };
  return std::hypot(along(value(column - 1, row), value(column + 1, row)), along(value(column, row - 1), value(column, row + 1)));
}

Block block_of(const Elevation& before, const Elevation& after, const MapGrid& part, const ErrorModel& model) {
  Block block{onto_grid(before, part), onto_grid(after, part), {part, std::vector<double>(part.count())}, {part, std::vector<double>(part.count())}};
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.columns; ++column) {
      const double d = block.after.at(column, row) - block.before.at(column, row);
      block.difference.at(column, row) = d;
      block.sigma.at(column, row) = std::isnan(d) ? d : model.sigma(slope_at(block.before, column, row));
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
