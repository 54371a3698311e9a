// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/block_means.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/map/regions.hpp"

namespace talus::postprocess {
namespace {

constexpr double blocks_wanted = 50;
constexpr int samples = 4;  // of a block's side, for the mean correlation of two blocks

double spherical(double distance, double range) {
  const double share = distance / range;
  return share < 1 ? 1 - 1.5 * share + 0.5 * share * share * share : 0;
}

/// The mean correlation of places in two blocks, the second displaced by (dx, dy).
double mean_correlation(double dx, double dy, double side, double range) {
  double sum = 0;
  for (int i = 1 - samples; i < samples; ++i)
    for (int j = 1 - samples; j < samples; ++j)
      sum += (samples - std::abs(i)) * (samples - std::abs(j)) *
             spherical(std::hypot(dx + i * side / samples, dy + j * side / samples), range);
  return sum / std::pow(samples, 4);
}

/// The cells of a mass without what noise gives: fringes, and patches that hold less than a block does. All of them
/// where none is left.
std::vector<char> without_noise(const MapGrid& grid, const std::vector<double>& surveyed,
                                const std::vector<char>& mass) {
  std::vector<double> marked(mass.begin(), mass.end());
  cut_fringe(grid, marked);
  for (std::size_t cell = 0; cell < marked.size(); ++cell) marked[cell] = marked[cell] > 0 ? surveyed[cell] : 0;
  const std::vector<Region> patches = regions_above({grid, std::move(marked)}, 0);
  double least = 0;
  for (const Region& patch : patches) least += patch.volume / blocks_wanted;
  std::vector<char> kept(mass.size(), 0);
  for (const Region& patch : patches)
    for (const std::size_t cell : patch.cells) kept[cell] = patch.volume >= least ? 1 : 0;
  return std::ranges::find(kept, 1) != kept.end() ? kept : mass;
}

}  // namespace

BlockMeans::BlockMeans(const MapGrid& grid, const std::vector<double>& surveyed, const std::vector<char>& mass,
                       double least_side, double least)
    : cell_(grid.cell), least_(least), block_of_(grid.count(), out) {
  const std::vector<char> inside = without_noise(grid, surveyed, mass);
  const auto cells = static_cast<double>(std::ranges::count_if(inside, [](char one) { return one != 0; }));
  side_ = std::max(static_cast<int>(std::lround(std::sqrt(cells / blocks_wanted))),
                   static_cast<int>(std::ceil(least_side / cell_ - 1e-6)));
  side_ = std::max(1, side_);
  const MapGrid coarse{(grid.columns + side_ - 1) / side_,
                       (grid.rows + side_ - 1) / side_,
                       grid.west,
                       grid.south,
                       side_ * cell_,
                       grid.crs_wkt};
  std::vector<double> known(coarse.count(), 0);
  std::vector<char> holds(coarse.count(), 0);
  const auto block_at = [&](int column, int row) { return coarse.index(column / side_, row / side_); };
  each_cell(grid, [&](int column, int row) {
    const std::size_t cell = grid.index(column, row), block = block_at(column, row);
    if (std::isfinite(surveyed[cell])) ++known[block];
    if (inside[cell] != 0) holds[block] = 1;
  });
  std::vector<int> number(coarse.count(), beyond);
  for (std::size_t block = 0; block < known.size(); ++block) {
    if (holds[block] == 0 || 2 * known[block] < side_ * side_) continue;
    const auto [column, row] = coarse.cell_of(block);
    each_near(coarse, {column, row}, 1, [&](int c, int r) {
      if (number[coarse.index(c, r)] == beyond) number[coarse.index(c, r)] = beside;
    });
    number[block] = static_cast<int>(places_.size());
    places_.push_back({coarse.x(column), coarse.y(row)});
    cells_in_.push_back(known[block]);
  }
  each_cell(grid, [&](int column, int row) {
    const std::size_t cell = grid.index(column, row);
    if (std::isfinite(surveyed[cell])) block_of_[cell] = number[block_at(column, row)];
  });
  extent_ = side();
  for (const auto& [xa, ya] : places_)
    for (const auto& [xb, yb] : places_) extent_ = std::max(extent_, std::hypot(xa - xb, ya - yb));
}

std::vector<std::array<double, 2>> BlockMeans::places() const {
  constexpr double far = 1e9;
  std::vector<std::array<double, 2>> all = places_;
  all.push_back({far, far});
  return all;
}

std::vector<double> BlockMeans::of(const std::vector<double>& values) const {
  std::vector<double> sums(count() + 1, 0.0);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    const int block = block_of_[cell];
    if (!std::isfinite(values[cell]) || block == out) continue;
    if (block >= 0)
      sums[static_cast<std::size_t>(block)] += values[cell] / cells_in_[static_cast<std::size_t>(block)];
    else if (values[cell] > (block == beside ? 0 : least_))
      sums.back() += values[cell];
  }
  sums.back() /= all_cells();
  return sums;
}

double BlockMeans::volume_beside(const std::vector<double>& values) const {
  double sum = 0;
  for (std::size_t cell = 0; cell < values.size(); ++cell)
    if (block_of_[cell] == beside && std::isfinite(values[cell])) sum += values[cell];
  return sum / all_cells();
}

double BlockMeans::all_cells() const { return std::max(1.0, std::accumulate(cells_in_.begin(), cells_in_.end(), 0.0)); }

std::vector<double> BlockMeans::covariance(const std::vector<double>& deviation, double range) const {
  const std::size_t n = count() + 1;
  std::vector<double> squares(n, 0.0), matrix(n * n, 0.0);
  for (std::size_t cell = 0; cell < deviation.size(); ++cell) {
    if (!std::isfinite(deviation[cell])) continue;
    const int block = block_of_[cell];
    const double square = deviation[cell] * deviation[cell];
    if (block >= 0) squares[static_cast<std::size_t>(block)] += square / cells_in_[static_cast<std::size_t>(block)];
    if (block == beside) matrix.back() += square;
  }
  const double err_alike = std::max(1.0, std::numbers::pi / 5 * range * range / (cell_ * cell_));  // cells
  matrix.back() *= err_alike / std::pow(all_cells(), 2);
  for (std::size_t a = 0; a + 1 < n; ++a) {
    if (!(range > 0)) matrix[a * n + a] = squares[a] / cells_in_[a];
    for (std::size_t b = 0; range > 0 && b + 1 < n; ++b)
      matrix[a * n + b] = std::sqrt(squares[a] * squares[b]) *
                          mean_correlation(places_[a][0] - places_[b][0], places_[a][1] - places_[b][1], side(), range);
  }
  return matrix;
}

}  // namespace talus::postprocess
