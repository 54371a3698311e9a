// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of two surveys from which their misfit is learnt: the whole where it is small, else an even spread of it;
// which of their cells are stable, and how fields on them become waves.
#pragma once

#include <complex>
#include <vector>

#include "common/map/polygon.hpp"
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

/// Marks the cells of the patches that are steep (beyond 45 degrees: a small shift changes them much), rough (more than
/// the median by three NMAD) or inside a polygon, as the slide and all else that changed, as not stable. Roughness is
/// the distance from the mean of the eight neighbours.
void find_stable(std::vector<Patch>& patches, const std::vector<MapPolygon>& changed);

/// Takes out of the stable and the unchanged ground what changed between the surveys: connected regions of 20 cells and
/// more whose misfit stands out by more than three NMAD in most cells around, and three cells more.
void leave_out_changed(std::vector<Patch>& patches, const Placement& placement);

using Waves = std::vector<std::complex<double>>;  // [high * wide], see fourier_transform()

/// The cells of a patch of which a fit by wavelengths makes use, and how fields on them become waves. All that is done
/// to a field is linear in it and the same for every field, so that relations between fields hold between waves.
class PatchWindow {
 public:
  /// `used` [rows * columns]: cells that count; fields have values there.
  PatchWindow(const MapGrid& grid, std::vector<char> used);

  /// A field without the plane that fits its cells best, with its holes filled smoothly (a hole's edge would spread
  /// each wave over all lengths), and faded out within an eighth of the patch's width of its rim.
  std::vector<double> prepared(const std::vector<double>& field) const;

  /// The waves of two fields at once: first + i second, both as prepared() leaves them; `second` may be empty.
  Waves waves(const std::vector<double>& first, const std::vector<double>& second) const;

  /// Mean square of the fading over the transformed cells, holes as 0: the share of them that tells something.
  double share() const { return share_; }
  bool enough() const { return enough_; }  ///< false: too few cells count
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int wide() const { return wide_; }  ///< of the plane of waves
  int high() const { return high_; }  ///< of the plane of waves

 private:
  std::vector<double> without_plane(const std::vector<double>& field) const;

  int columns_, rows_, wide_, high_;
  std::vector<char> used_;
  std::vector<double> fade_x_, fade_y_;
  double share_ = 0;
  bool enough_ = false;
};

/// The values of the cells [rows * columns] that count, and a smooth surface through them in the others: means over 2 x
/// 2, 4 x 4, ... cells, blended linearly from the coarsest on (pull-push of Gortler et al. 1996, "The Lumigraph").
/// Linear in the values: what two fields have in common, their filled ones have. 0 throughout where no cell counts.
std::vector<double> smooth_fill(const std::vector<double>& values, const std::vector<char>& counts, int columns,
                                int rows);

}  // namespace talus::preprocess
