// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "common/map/fourier.hpp"
#include "common/map/raster.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"

namespace talus::preprocess {
namespace {

constexpr int lattice = 8;  // patches along each side

/// Horn's (1981) derivatives: the rows beside count once, the own row twice.
void find_slopes(Patch& patch) {
  const Raster& z = patch.before;
  const MapGrid& grid = z.grid;
  patch.slope_x.assign(grid.count(), nan);
  patch.slope_y = patch.slope_x;
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      double x = 0, y = 0;
      for (int k = -1; k <= 1; ++k) {
        const double weight = k == 0 ? 2 : 1;
        x += weight * (z.at(column + 1, row + k) - z.at(column - 1, row + k));
        y += weight * (z.at(column + k, row + 1) - z.at(column + k, row - 1));
      }
      patch.slope_x[grid.index(column, row)] = x / (8 * grid.cell);
      patch.slope_y[grid.index(column, row)] = y / (8 * grid.cell);
    }
  }
}

Patch patch_of(const Elevation& before, const Elevation& after, const MapGrid& part) {
  const double margin = patch_margin * std::max(part.cell, after.cell());
  Patch patch{onto_grid(before, part), {}, {}, {}, {}, {}, {}};
  patch.after = part_of(after, {part.west - margin, part.south - margin, part.east() + margin, part.north() + margin},
                        part.crs_wkt);
  patch.unchanged.assign(part.count(), 1);
  patch.stable = patch.gentle = patch.unchanged;
  find_slopes(patch);
  return patch;
}

/// Distance of every cell from the mean of its eight neighbours [m]; NaN where one is missing.
std::vector<double> roughness_of(const Raster& z) {
  const MapGrid& grid = z.grid;
  std::vector<double> roughness(grid.count(), nan);
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      double sum = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) sum += z.at(column + i, row + j);
      const double here = z.at(column, row);
      roughness[grid.index(column, row)] = std::abs(here - (sum - here) / 8);
    }
  }
  return roughness;
}

constexpr double steepest = 45;           // [deg] of stable ground
constexpr double roughest = 3;            // NMAD beyond the median
constexpr double beyond_nmads = 3;        // limit of what changed, over the NMAD
constexpr std::size_t least_region = 20;  // cells: fewer are noise
constexpr int rim = 3;                    // cells around a change, where it thins out

/// The share of the 3 x 3 cells around each that are marked, of those on the map: small for a single cell of noise.
Raster marked_share(const MapGrid& grid, const std::vector<double>& marked) {
  Raster share{grid, std::vector<double>(grid.count(), 0.0)};
  each_cell(grid, [&](int column, int row) {
    const Neighbours around = neighbours_of(grid, marked, column, row);
    share.at(column, row) = static_cast<double>(around.marked) / around.inside;
  });
  return share;
}

void leave_out(const Region& region, const MapGrid& grid, std::vector<char>& kept) {
  for (const std::size_t cell : region.cells)
    each_near(grid, grid.cell_of(cell), rim, [&](int c, int r) { kept[grid.index(c, r)] = 0; });
}

constexpr double faded = 0.125;       // of the width, on each side
constexpr double least_share = 0.02;  // of the cells of a patch: with fewer its fields are all but filled

/// A cosine's rise from 0 to 1 at both ends.
std::vector<double> fading(int count) {
  std::vector<double> fade(static_cast<std::size_t>(count), 1.0);
  const int rise = std::max(4, static_cast<int>(faded * count));
  for (int i = 0; i < std::min(rise, count); ++i) {
    const double value = 0.5 - 0.5 * std::cos(std::numbers::pi * (i + 0.5) / rise);
    const auto first = static_cast<std::size_t>(i), last = static_cast<std::size_t>(count - 1 - i);
    fade[first] = std::min(fade[first], value);
    fade[last] = std::min(fade[last], value);
  }
  return fade;
}

struct Means {
  int columns, rows;
  std::vector<double> value, weight;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

Means coarser(const Means& fine) {
  Means coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}, {}};
  coarse.value.assign(coarse.index(0, coarse.rows), 0.0);
  coarse.weight = coarse.value;
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t i = fine.index(column, row), to = coarse.index(column / 2, row / 2);
      coarse.value[to] += fine.weight[i] * fine.value[i];
      coarse.weight[to] += fine.weight[i];
    }
  }
  for (std::size_t i = 0; i < coarse.value.size(); ++i) {
    if (coarse.weight[i] > 0) coarse.value[i] /= coarse.weight[i];
    coarse.weight[i] = std::min(1.0, coarse.weight[i]);
  }
  return coarse;
}

/// Gives cells what they lack of a whole weight from coarser ones, bilinearly.
void fill_from(const Means& coarse, Means& fine) {
  for (int row = 0; row < fine.rows; ++row) {
    const int near_row = row / 2, far_row = std::clamp(row % 2 ? near_row + 1 : near_row - 1, 0, coarse.rows - 1);
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t i = fine.index(column, row);
      if (fine.weight[i] >= 1) continue;
      const int near = column / 2, far = std::clamp(column % 2 ? near + 1 : near - 1, 0, coarse.columns - 1);
      const auto along = [&](int r) {
        return 0.75 * coarse.value[coarse.index(near, r)] + 0.25 * coarse.value[coarse.index(far, r)];
      };
      const double around = 0.75 * along(near_row) + 0.25 * along(far_row);
      fine.value[i] = fine.weight[i] * fine.value[i] + (1 - fine.weight[i]) * around;
    }
  }
}

}  // namespace

std::vector<double> smooth_fill(const std::vector<double>& values, const std::vector<char>& counts, int columns,
                                int rows) {
  std::vector<Means> levels{{columns, rows, values, std::vector<double>(counts.begin(), counts.end())}};
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!counts[i]) levels.front().value[i] = 0;  // may be NaN
  while (levels.back().columns > 1 || levels.back().rows > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t k = levels.size() - 1; k-- > 0;) fill_from(levels[k + 1], levels[k]);
  return std::move(levels.front().value);
}

std::vector<Patch> patches_of(const Elevation& before, const Elevation& after, const MapGrid& grid) {
  std::vector<Patch> patches;
  if (grid.count() <= most_patch_cells) {
    patches.push_back(patch_of(before, after, grid));
    return patches;
  }
  const int side = static_cast<int>(std::sqrt(static_cast<double>(most_patch_cells))) / lattice;
  for (int j = 0; j < lattice; ++j) {
    for (int i = 0; i < lattice; ++i) {
      const auto first = [](int cells, int size, int k) { return (cells * (2 * k + 1) / lattice - size) / 2; };
      const int width = std::min(side, grid.columns / lattice), height = std::min(side, grid.rows / lattice);
      if (width < 3 || height < 3) continue;
      patches.push_back(patch_of(
          before, after, cut(grid, {first(grid.columns, width, i), first(grid.rows, height, j), width, height})));
    }
  }
  return patches;
}

std::vector<double> misfit(const Patch& patch, const Placement& placement) {
  Elevation after = patch.after;
  after.placement = placement;
  std::vector<double> difference = onto_grid(after, patch.before.grid).values;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= patch.before.values[i];
  return difference;
}

std::vector<double> stable_misfit(const std::vector<Patch>& patches, const Placement& placement) {
  std::vector<double> all;
  for (const Patch& p : patches) {
    const std::vector<double> d = misfit(p, placement);
    for (std::size_t i = 0; i < d.size(); ++i)
      if (p.stable[i] && !std::isnan(d[i])) all.push_back(d[i]);
  }
  return all;
}

void find_stable(std::vector<Patch>& patches, const std::vector<MapPolygon>& changed) {
  std::vector<std::vector<double>> roughness;
  std::vector<double> all;
  for (const Patch& patch : patches) {
    roughness.push_back(roughness_of(patch.before));
    for (const double r : roughness.back())
      if (!std::isnan(r)) all.push_back(r);
  }
  const double rough = median(all) + roughest * nmad(all);
  const double steep = std::tan(steepest * std::numbers::pi / 180);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    Patch& patch = patches[p];
    const std::vector<char> outside = cells_inside(changed, patch.before.grid);
    for (std::size_t i = 0; i < patch.stable.size(); ++i) {
      const double slope = std::hypot(patch.slope_x[i], patch.slope_y[i]);
      patch.unchanged[i] = !outside[i];
      patch.gentle[i] = slope <= steep;  // false for NaN
      patch.stable[i] = patch.gentle[i] && roughness[p][i] <= rough && patch.unchanged[i];
    }
  }
}

void leave_out_changed(std::vector<Patch>& patches, const Placement& placement) {
  std::vector<std::vector<double>> misfits;
  std::vector<double> all;
  for (const Patch& p : patches) {
    misfits.push_back(misfit(p, placement));
    for (std::size_t i = 0; i < p.stable.size(); ++i)
      if (p.stable[i] && !std::isnan(misfits.back()[i])) all.push_back(misfits.back()[i]);
  }
  const double centre = median(all), limit = beyond_nmads * std::max(nmad(all), 1e-6);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const MapGrid& grid = patches[p].before.grid;
    std::vector<double> marked(grid.count());
    for (std::size_t i = 0; i < marked.size(); ++i)
      marked[i] = std::abs(misfits[p][i] - centre) > limit;  // false for NaN
    for (const Region& region : regions_above(marked_share(grid, marked), 0.5)) {
      if (region.cells.size() < least_region) continue;
      leave_out(region, grid, patches[p].stable);
      leave_out(region, grid, patches[p].unchanged);
    }
  }
}

PatchWindow::PatchWindow(const MapGrid& grid, std::vector<char> used)
    : columns_(grid.columns),
      rows_(grid.rows),
      wide_(fourier_length(grid.columns)),
      high_(fourier_length(grid.rows)),
      used_(std::move(used)),
      fade_x_(fading(grid.columns)),
      fade_y_(fading(grid.rows)) {
  std::size_t i = 0, count = 0;
  for (const double y : fade_y_) {
    for (const double x : fade_x_) {
      count += used_[i] != 0;
      share_ += used_[i++] ? x * x * y * y : 0;
    }
  }
  share_ /= static_cast<double>(wide_) * high_;
  enough_ = static_cast<double>(count) > std::max(64.0, least_share * static_cast<double>(used_.size()));
}

std::vector<double> PatchWindow::without_plane(const std::vector<double>& field) const {
  const auto row_of = [&](std::size_t i) {
    const auto columns = static_cast<std::size_t>(columns_);
    const std::size_t row = i / columns, column = i % columns;
    return Eigen::Vector3d(1, static_cast<double>(column) / columns_ - 0.5, static_cast<double>(row) / rows_ - 0.5);
  };
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (!used_[i]) continue;
    const Eigen::Vector3d row = row_of(i);
    matrix += row * row.transpose();
    right += field[i] * row;
  }
  const Eigen::Vector3d plane = matrix.ldlt().solve(right);
  std::vector<double> rest(field.size(), 0.0);
  for (std::size_t i = 0; i < used_.size(); ++i)
    if (used_[i]) rest[i] = field[i] - plane.dot(row_of(i));
  return rest;
}

std::vector<double> PatchWindow::prepared(const std::vector<double>& field) const {
  std::vector<double> ready = smooth_fill(without_plane(field), used_, columns_, rows_);
  std::size_t i = 0;
  for (const double y : fade_y_)
    for (const double x : fade_x_) ready[i++] *= x * y;
  return ready;
}

Waves PatchWindow::waves(const std::vector<double>& first, const std::vector<double>& second) const {
  const std::vector<double> real = prepared(first), imaginary = second.empty() ? second : prepared(second);
  Waves waves(static_cast<std::size_t>(wide_) * static_cast<std::size_t>(high_));
  const auto columns = static_cast<std::size_t>(columns_), width = static_cast<std::size_t>(wide_);
  for (std::size_t i = 0; i < real.size(); ++i)
    waves[i / columns * width + i % columns] = {real[i], imaginary.empty() ? 0.0 : imaginary[i]};
  fourier_transform(waves, wide_, high_);
  return waves;
}

}  // namespace talus::preprocess
