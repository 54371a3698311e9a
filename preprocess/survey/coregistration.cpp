// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/coregistration.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/survey/shift_fit.hpp"

namespace talus::preprocess {
namespace {

constexpr int farthest = 16;  // cells
constexpr std::size_t most_samples = 20000;
constexpr double clearly_better = 0.9;

/// The later survey on the cells of a patch and `farthest` more on every side.
struct Wide {
  const Patch* patch;
  Raster after;
};

std::vector<Wide> widened(const std::vector<Patch>& patches, const Placement& placement) {
  std::vector<Wide> wide;
  for (const Patch& p : patches) {
    MapGrid grid = p.before.grid;
    grid.west -= farthest * grid.cell;
    grid.south -= farthest * grid.cell;
    grid.columns += 2 * farthest;
    grid.rows += 2 * farthest;
    Elevation after = p.after;
    after.placement = placement;
    wide.push_back({&p, onto_grid(after, grid)});
  }
  return wide;
}

/// Misfit of the sampled cells with the later survey moved by whole cells.
std::vector<double> misfit_at(const std::vector<Wide>& wide, std::size_t stride, int east, int north) {
  std::vector<double> all;
  std::size_t seen = 0;
  for (const Wide& w : wide) {
    const MapGrid& grid = w.patch->before.grid;
    each_cell(grid, [&](int column, int row) {
      const std::size_t i = grid.index(column, row);
      if (!w.patch->stable[i] || seen++ % stride != 0) return;
      const double d = w.after.at(column + farthest - east, row + farthest - north) - w.patch->before.values[i];
      if (!std::isnan(d)) all.push_back(d);
    });
  }
  return all;
}

/// Moves the placement by the whole-cell shift, at most 16 cells either way, at which the misfit of a thinned set of
/// stable cells has the least NMAD; stays where no shift is a tenth better. A fit that starts there does not lose its
/// way among hills narrower than the shift.
void move_by_whole_cells(const std::vector<Patch>& patches, Placement& placement) {
  std::size_t stable = 0;
  for (const Patch& p : patches) stable += static_cast<std::size_t>(std::count(p.stable.begin(), p.stable.end(), 1));
  const std::size_t stride = std::max<std::size_t>(1, stable / most_samples) | 1;  // odd: not all in one column
  const std::vector<Wide> wide = widened(patches, placement);
  const std::vector<double> here = misfit_at(wide, stride, 0, 0);
  double least = clearly_better * nmad(here);
  int east = 0, north = 0;
  for (int n = -farthest; n <= farthest; ++n) {
    for (int e = -farthest; e <= farthest; ++e) {
      const std::vector<double> there = misfit_at(wide, stride, e, n);
      if (there.size() * 2 < here.size()) continue;  // moved off the other survey
      const double spread = nmad(there);
      if (spread < least) least = spread, east = e, north = n;
    }
  }
  placement.x += east * patches.front().before.grid.cell;
  placement.y += north * patches.front().before.grid.cell;
}

constexpr int most_iterations = 50;
constexpr double still = 1e-3;      // cells: what is left of a shift at the end
constexpr int free_iterations = 3;  // after which no cell comes back

void move(Placement& placement, const ShiftFit& fit, double length) {
  placement.x += fit.value[shift_x];
  placement.y += fit.value[shift_y];
  placement.z += fit.value[shift_z];
  placement.tilt_x += fit.value[ShiftUnknown::tilt_x] / length;
  placement.tilt_y += fit.value[ShiftUnknown::tilt_y] / length;
}

/// Heights in feet stretch relief, not only lift it: spreads differ by that factor.
void refuse_feet(const std::vector<Patch>& patches, const Placement& placement,
                 const std::filesystem::path& after_file) {
  std::vector<double> before, after;
  for (const Patch& p : patches) {
    const std::vector<double> d = misfit(p, placement);
    for (std::size_t i = 0; i < d.size(); ++i) {
      if (std::isnan(d[i])) continue;
      before.push_back(p.before.values[i]);
      after.push_back(p.before.values[i] + d[i]);
    }
  }
  const double ratio = nmad(after) / nmad(before);
  for (const double feet : {1 / 0.3048, 0.3048}) {
    if (!(std::abs(ratio / feet - 1) < 0.15)) continue;  // no slide changes the relief of a map threefold
    const bool later = feet > 1;
    throw DataError(
        {fmt::format("{}: its relief is {:.3f} times that of the survey before", after_file.string(), ratio),
         fmt::format("{} look like feet, or were stretched to be drawn; a known summit tells",
                     later ? "its heights" : "the heights of the survey before"),
         fmt::format("Declare it in {0}_dem: gdal_edit.py -units foot (or us-survey-foot) FILE; or, where the other "
                     "one is said to be in feet and is not, in {1}_dem: gdal_edit.py -units metre FILE",
                     later ? "after" : "before", later ? "before" : "after")});
  }
}

Residuals residuals_of(const std::vector<double>& values) {
  Residuals r{talus::median(values), talus::nmad(values), 0, 0, values.size()};
  std::vector<double> sizes;
  double squares = 0;
  for (const double v : values) {
    sizes.push_back(std::abs(v));
    squares += v * v;
  }
  r.median_absolute = talus::median(sizes);
  r.rmse = std::sqrt(squares / static_cast<double>(values.size()));
  return r;
}

/// Cells without both surveys no longer count as stable.
void leave_out_unshared(std::vector<Patch>& patches, const Placement& placement) {
  for (Patch& p : patches) {
    const std::vector<double> d = misfit(p, placement);
    for (std::size_t i = 0; i < d.size(); ++i) p.stable[i] &= !std::isnan(d[i]);
  }
}

/// Iterates the fit of what is sought until it stands still; leaves the last errors. Near a shift by whole cells, a row
/// at the rim is shared at every other iterate alone: after some iterations, who is out stays out.
ShiftFit settle(std::vector<Patch>& patches, const std::vector<int>& sought, double length, Coregistration& result) {
  ShiftFit last;
  const double cell = patches.front().before.grid.cell;
  result.converged = false;
  for (int i = 0; i < most_iterations && !result.converged; ++i) {
    if (i >= free_iterations) leave_out_unshared(patches, result.placement);
    const ShiftRows rows = rows_of(patches, result.placement, length);
    if (rows.misfit.size() < least_cells) break;  // moved off one another
    last = fit_shift(rows, sought);
    move(result.placement, last, length);
    ++result.iterations;
    result.converged = std::hypot(last.value[0], last.value[1]) < still * cell &&
                       std::abs(last.value[2]) < still * std::max(nmad(rows.misfit), 1e-6);
  }
  return last;
}

/// The misfits of stable cells at two placements, of the cells that have one at both.
std::array<std::vector<double>, 2> shared_misfits(const std::vector<Patch>& patches, const Placement& one,
                                                  const Placement& other) {
  std::array<std::vector<double>, 2> both;
  for (const Patch& p : patches) {
    const std::vector<double> first = misfit(p, one), second = misfit(p, other);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (!p.stable[i] || std::isnan(first[i] + second[i])) continue;
      both[0].push_back(first[i]);
      both[1].push_back(second[i]);
    }
  }
  return both;
}

/// True where a correction raises NMAD or median size of the misfit: it makes worse what it should mend.
bool raises_spread(const std::vector<Patch>& patches, const Placement& from, const Placement& to) {
  const auto [was, is] = shared_misfits(patches, from, to);
  const Residuals before = residuals_of(was), after = residuals_of(is);
  return after.nmad > before.nmad || after.median_absolute > before.median_absolute;
}

/// A tilt within three times its error is noise. Cells beside one another err alike: one in a hundred counts.
void fit_tilt(std::vector<Patch>& patches, std::vector<int> sought, double length, Coregistration& result) {
  Coregistration tilted = result;
  sought.insert(sought.end(), {ShiftUnknown::tilt_x, ShiftUnknown::tilt_y});
  const ShiftFit last = settle(patches, sought, length, tilted);
  const auto clear = [&](double tilt, double error) { return std::abs(tilt * length) > 3 * 10 * error + 1e-9; };
  if (tilted.converged && !raises_spread(patches, result.placement, tilted.placement) &&
      (clear(tilted.placement.tilt_x, last.error[ShiftUnknown::tilt_x]) ||
       clear(tilted.placement.tilt_y, last.error[ShiftUnknown::tilt_y])))
    result = tilted;
}

/// The shift anew by bands of wavelengths, and the height that goes with it.
void refine(std::vector<Patch>& patches, double length, Coregistration& result) {
  const RefinedShift shift = refined_shift(patches, result.placement);
  result.shift_error = shift.error;
  if (!shift.known) return;
  result.placement.x += shift.x;
  result.placement.y += shift.y;
  settle(patches, {shift_z}, length, result);
}

Extent extent_of(const std::vector<Patch>& patches) {
  Extent all{INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (const Patch& p : patches) {
    const MapGrid& grid = p.before.grid;
    all = {std::min(all.west, grid.west), std::min(all.south, grid.south), std::max(all.east, grid.east()),
           std::max(all.north, grid.north())};
  }
  return all;
}

/// Cells that both surveys hold.
std::size_t shared_cells(const std::vector<Patch>& patches, const Placement& placement) {
  std::size_t count = 0;
  for (const Patch& p : patches)
    for (const double d : misfit(p, placement)) count += !std::isnan(d);
  return count;
}

/// What is said in the end. A placement at which the surveys share less than half of what they did is not believed, and
/// one at which stable ground is spread more than it was is left for the height alone.
Coregistration told(const std::vector<Patch>& patches, const Placement& start, Coregistration result) {
  if (raises_spread(patches, start, result.placement)) {
    result.placement = start;
    result.placement.z = -median(stable_misfit(patches, start));
    if (raises_spread(patches, start, result.placement)) result.placement = start;
  }
  const auto [was, rest] = shared_misfits(patches, start, result.placement);
  result.unaligned = residuals_of(was);
  result.known =
      rest.size() >= least_cells && 2 * shared_cells(patches, result.placement) > shared_cells(patches, start);
  result.aligned = residuals_of(rest);
  std::size_t cells = 0;
  for (const Patch& p : patches) cells += p.stable.size();
  result.stable_share = static_cast<double>(rest.size()) / static_cast<double>(cells);
  return result;
}

/// Most cells differ by the same number: the later model was made from the earlier one, and no more is to be fitted.
Coregistration lifted(std::vector<Patch>& patches, Coregistration result) {
  const Placement start = result.placement;
  result.placement.z = -median(stable_misfit(patches, start));
  leave_out_changed(patches, result.placement);
  result.converged = true;
  result.shift_known = false;
  return told(patches, start, result);
}

}  // namespace

Coregistration coregister(std::vector<Patch>& patches, bool tilt, const std::filesystem::path& after_file) {
  Coregistration result;
  const Extent extent = extent_of(patches);
  const double length = extent.east - extent.west;
  result.placement.centre_x = (extent.west + extent.east) / 2;
  result.placement.centre_y = (extent.south + extent.north) / 2;
  const std::vector<double> first_misfit = stable_misfit(patches, result.placement);
  const std::size_t at_first = first_misfit.size();
  if (at_first < least_cells) return result;
  if (nmad(first_misfit) < 1e-9) return lifted(patches, result);
  refuse_feet(patches, result.placement, after_file);
  const Placement start = result.placement;
  move_by_whole_cells(patches, result.placement);
  std::vector<int> sought{shift_z};
  result.shift_known = tells_a_shift(rows_of(patches, result.placement, length));
  if (result.shift_known) sought = {shift_x, shift_y, shift_z};
  settle(patches, sought, length, result);
  for (int round = 0; round < 2; ++round) {
    leave_out_changed(patches, result.placement);
    if (stable_misfit(patches, result.placement).size() < std::max<std::size_t>(least_cells, at_first / 2))
      return result;
    settle(patches, sought, length, result);
  }
  if (tilt) fit_tilt(patches, sought, length, result);
  if (result.shift_known) refine(patches, length, result);
  return told(patches, start, result);
}

}  // namespace talus::preprocess
