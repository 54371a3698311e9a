// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/height_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t least_cells = 400;  // fewer have no statistics: 20 x 20
constexpr double hardly_matters = 0.1;    // [m] below what surveys tell apart
constexpr double noise_like = 0.8;
constexpr double level_share = 0.05, lower_share = 0.1;
constexpr std::size_t least_line = 40;
constexpr double same_sign = 0.9, beyond_bends = 2;

std::vector<double> valid_heights(const Raster& heights) {
  std::vector<double> valid;
  valid.reserve(heights.values.size());
  for (const double z : heights.values)
    if (!std::isnan(z)) valid.push_back(z);
  return valid;
}

/// f(height, neighbour) for each cell and its eastern and northern neighbour, where both have a height.
template <class F>
void each_pair(const Raster& heights, F&& f) {
  const int columns = heights.grid.columns, rows = heights.grid.rows;
  each_cell(heights.grid, [&](int c, int r) {
    const double z = heights.at(c, r);
    if (std::isnan(z)) return;
    if (c + 1 < columns && !std::isnan(heights.at(c + 1, r))) f(z, heights.at(c + 1, r));
    if (r + 1 < rows && !std::isnan(heights.at(c, r + 1))) f(z, heights.at(c, r + 1));
  });
}

/// f(height, next, next but one) along rows and columns, where all have a height.
template <class F>
void each_triple(const Raster& heights, F&& f) {
  const int columns = heights.grid.columns, rows = heights.grid.rows;
  const auto call = [&](double before, double z, double after) {
    if (!std::isnan(before + z + after)) f(before, z, after);
  };
  each_cell(heights.grid, [&](int c, int r) {
    if (c > 0 && c + 1 < columns) call(heights.at(c - 1, r), heights.at(c, r), heights.at(c + 1, r));
    if (r > 0 && r + 1 < rows) call(heights.at(c, r - 1), heights.at(c, r), heights.at(c, r + 1));
  });
}

/// The jump over the line between cells `at` and `at` + 1, where the line is one of jumps; 0 elsewhere. `along` cells
/// lie along it; height(cell along it, cell across).
template <class Height>
double jump_over(int at, int along, const Height& height) {
  std::vector<double> jumps, bends;
  for (int k = 0; k < along; ++k) {
    const double before = height(k, at) - height(k, at - 1), here = height(k, at + 1) - height(k, at),
                 after = height(k, at + 2) - height(k, at + 1);
    if (std::isnan(before + here + after)) continue;
    jumps.push_back(here - (before + after) / 2);
    bends.push_back(after - before);
  }
  if (jumps.size() < least_line) return 0;
  const double jump = median(jumps);
  const auto alike = std::ranges::count_if(jumps, [&](double one) { return one * jump > 0; });
  const bool straight = std::abs(jump) > std::max(hardly_matters, beyond_bends * std::abs(median(bends))) &&
                        static_cast<double>(alike) >= same_sign * static_cast<double>(jumps.size());
  return straight ? jump : 0;
}

bool warn_of_straight_jumps(const Raster& heights, const std::filesystem::path& file) {
  const StraightJumps found = straight_jumps(heights);
  if (found.rows + found.columns == 0) return false;
  warn("straight-jumps",
       fmt::format("{}: heights jump by {:.2g} m (median) over {} lines along rows and {} along columns, from rim to "
                   "rim, the first at {} {:.1f}: stripes of a scanner, or tiles of a mosaic that do not fit. A dam, a "
                   "wall or terraces as straight as that are ground. Level the parts, or take another model",
                   file.string(), found.size, found.rows, found.columns, found.rows > 0 ? "y" : "x", found.at),
       {{"jump", found.size, "m"}, {"lines", static_cast<double>(found.rows + found.columns), "1"}});
  return true;
}

bool warn_of_steps(const Raster& heights, const std::filesystem::path& file) {
  const double step = common_step(heights, hardly_matters);
  if (step == 0) return false;
  warn("stepped-heights",
       fmt::format(
           "{}: heights come in steps of {:.3g} m (integers, or rounded): each is off by {:.2g} m (one sigma), and a "
           "slope from cell to cell is told in steps of {:.2g} degrees. Take real numbers where they are to be had",
           file.string(), step, step / std::sqrt(12.0), std::atan(step / heights.grid.cell) * 180 / std::numbers::pi),
       {{"step", step, "m"}});
  return true;
}

void warn_of_noise(const std::vector<Raster>& pieces, const std::filesystem::path& file) {
  std::vector<double> ratios;
  for (const Raster& piece : pieces)
    if (const double ratio = roughness_ratio(piece); !std::isnan(ratio)) ratios.push_back(ratio);
  const double ratio = ratios.empty() ? 0 : median(ratios);
  if (!(ratio > noise_like)) return;
  double low = INFINITY, high = -INFINITY;
  for (const Raster& piece : pieces)
    for (const double z : valid_heights(piece)) low = std::min(low, z), high = std::max(high, z);
  warn("noise-like-heights",
       fmt::format("{}: heights from {:.4g} to {:.4g} m change from cell to cell like noise (median second over first "
                   "difference {:.2f}; ground has 0.1 to 0.6): a map of slope, shade or another quantity; a surface "
                   "model with trees and houses on gentle ground; or a survey as noisy as its ground is high. Look at "
                   "it in a GIS before you trust a run on it",
                   file.string(), low, high, ratio),
       {{"roughness_ratio", ratio, "1"}});
}

bool warn_of_level_piece(const Raster& heights, const std::filesystem::path& file) {
  const LevelPiece level = most_common_height(heights);
  const double share = static_cast<double>(level.cells) / static_cast<double>(level.valid);
  if (share < level_share || level.lower_rim < lower_share) return false;
  const auto columns = static_cast<std::size_t>(heights.grid.columns);
  warn("level-ground",
       fmt::format("{}: {:.0f} % of {} cells hold {:.7g} m exactly, one at x {:.1f}, y {:.1f}, and {:.0f} % of what "
                   "lies around them is lower, so that it is no water: ground made level, cells filled with one value, "
                   "or a stretch without data",
                   file.string(), 100 * share, grouped(static_cast<double>(level.valid)), level.value,
                   heights.grid.x(static_cast<int>(level.first % columns)),
                   heights.grid.y(static_cast<int>(level.first / columns)), 100 * level.lower_rim),
       {{"share", share, "1"}, {"value", level.value, "m"}, {"lower_rim", level.lower_rim, "1"}});
  return true;
}

}  // namespace

double common_step(const Raster& heights, double least) {
  constexpr double nearly = 0.02;  // of a step: what rounding to single precision leaves
  std::vector<double> values = valid_heights(heights);
  std::ranges::sort(values);
  const auto same = [](double a, double b) { return b - a <= 1e-6 * std::max(1.0, std::abs(b)); };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
  if (values.size() < 3) return 0;
  double smallest = INFINITY;
  for (std::size_t i = 1; i < values.size(); ++i) smallest = std::min(smallest, values[i] - values[i - 1]);
  if (smallest < least * (1 - nearly)) return 0;
  std::vector<double> single;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] < 1.5 * smallest) single.push_back(values[i] - values[i - 1]);
  double step = median(single);
  for (const double z : values) {  // the further up, the better is a step known
    const double above = z - values.front(), count = std::round(above / step);
    if (std::abs(above - count * step) > nearly * step) return 0;
    if (count > 0) step = above / count;
  }
  std::size_t all = 0, bent = 0;
  each_triple(heights, [&](double before, double z, double after) {
    all += 1;
    if (std::abs(after - 2 * z + before) > 0.5 * step) bent += 1;
  });
  return static_cast<double>(bent) > nearly * static_cast<double>(all) ? step : 0;
}

double roughness_ratio(const Raster& heights) {
  std::vector<double> first, second;
  each_triple(heights, [&](double before, double z, double after) {
    first.push_back(std::abs(after - z));
    second.push_back(std::abs(after - 2 * z + before));
  });
  if (first.size() < least_cells) return NAN;
  const double usual = median(first);
  return usual > 0 ? median(second) / usual : NAN;
}

LevelPiece most_common_height(const Raster& heights) {
  std::vector<double> values = valid_heights(heights);
  LevelPiece piece;
  piece.valid = values.size();
  std::ranges::sort(values);
  for (std::size_t i = 0, next = 0; i < values.size(); i = next) {
    while (next < values.size() && values[next] == values[i]) ++next;
    if (next - i > piece.cells) piece = {.value = values[i], .cells = next - i, .valid = values.size()};
  }
  const auto found = std::ranges::find(heights.values, piece.value);
  piece.first = static_cast<std::size_t>(found - heights.values.begin());
  double lower = 0, all = 0;
  each_pair(heights, [&](double one, double other) {
    if ((one == piece.value) == (other == piece.value)) return;
    all += 1;
    if (std::min(one, other) < piece.value) lower += 1;
  });
  if (all > 0) piece.lower_rim = lower / all;
  return piece;
}

StraightJumps straight_jumps(const Raster& heights) {
  const MapGrid& grid = heights.grid;
  StraightJumps found;
  std::vector<double> sizes;
  const auto look = [&](int across, int along, double first, std::size_t& lines, const auto& height) {
    for (int at = 1; at + 2 < across; ++at) {
      const double jump = jump_over(at, along, height);
      if (jump == 0) continue;
      if (sizes.empty()) found.at = first + (at + 0.5) * grid.cell;
      ++lines;
      sizes.push_back(std::abs(jump));
    }
  };
  look(grid.rows, grid.columns, grid.y(0), found.rows, [&](int c, int r) { return heights.at(c, r); });
  look(grid.columns, grid.rows, grid.x(0), found.columns, [&](int r, int c) { return heights.at(c, r); });
  if (!sizes.empty()) found.size = median(sizes);
  return found;
}

bool is_level(const std::vector<double>& before, const std::vector<double>& after, double detection) {
  constexpr double least = 0.1, detections = 2;
  const double resolved = std::max(least, detections * detection);
  return quantile(before, 0.95) - quantile(before, 0.05) <= resolved &&
         quantile(after, 0.5) - quantile(after, 0.05) <= resolved;
}

void warn_of_statistics(std::vector<Raster> pieces, const std::filesystem::path& file) {
  const auto first_of = [&](bool (*warns)(const Raster&, const std::filesystem::path&)) {
    return std::ranges::any_of(pieces, [&](const Raster& piece) { return warns(piece, file); });
  };
  const auto few = [](const Raster& piece) { return valid_heights(piece).size() < least_cells; };
  if (pieces.size() > 1) std::erase_if(pieces, few);
  first_of(warn_of_steps);
  std::erase_if(pieces, few);
  warn_of_noise(pieces, file);
  first_of(warn_of_level_piece);
  first_of(warn_of_straight_jumps);
}

}  // namespace talus::preprocess
