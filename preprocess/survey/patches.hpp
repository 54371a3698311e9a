// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of two surveys from which their misfit is learnt: the whole where it is small, else an even spread of it.
#pragma once

#include <vector>

#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// A piece of both surveys on cells of the working grid.
struct Patch {
  Raster before;                         // on cells of the working grid
  std::vector<double> slope_x, slope_y;  // of it, rise per metre east and north; NaN where not known
  Elevation after;                       // as it was read, so that it is resampled once only; a margin wider
  std::vector<char> unchanged;           // cells that are not known to have changed: they tell the error
  std::vector<char> stable;              // of these, the ones neither steep nor rough: they tell where the fit begins
  std::vector<char> gentle;              // cells that are not too steep: with `unchanged` they tell the alignment
};

/// Cells of which a fit makes use: more add time, not digits.
inline constexpr std::size_t most_patch_cells = std::size_t{1} << 22;
/// Cells by which a patch of the later survey reaches further, and by which the two may be shifted.
inline constexpr int patch_margin = 32;

/// One patch that is the whole grid, or 64 squares on a lattice. Slopes by central differences (Horn 1981).
std::vector<Patch> patches_of(const Elevation& before, const Elevation& after, const MapGrid& grid);

/// After less before on the cells of a patch, the later survey at `placement` [m]; NaN where either has no value.
std::vector<double> misfit(const Patch& patch, const Placement& placement);

/// The misfit of the stable cells of all patches, where it is known.
std::vector<double> stable_misfit(const std::vector<Patch>& patches, const Placement& placement);

/// Moves the placement by the whole-cell shift, at most 16 cells either way, at which the misfit of a thinned set of
/// stable cells has the least NMAD; stays where no shift is a tenth better. A fit that starts there does not lose its
/// way among hills narrower than the shift.
void move_by_whole_cells(const std::vector<Patch>& patches, Placement& placement);

/// Takes out of the stable and the unchanged ground what changed between the surveys: connected regions of 20 cells and
/// more whose misfit stands out by more than three NMAD in most cells of their surroundings, and three cells around
/// them.
void leave_out_changed(std::vector<Patch>& patches, const Placement& placement);

}  // namespace talus::preprocess
