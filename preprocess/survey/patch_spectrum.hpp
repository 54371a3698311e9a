// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What of a patch tells a shift, as waves: fields on its cells, without a plane and without holes, faded out at the
// rim.
#pragma once

#include <complex>
#include <vector>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

using Waves = std::vector<std::complex<double>>;  // [high * wide], see fourier_transform()

/// The cells of a patch of which a fit by wavelengths makes use, and how fields on them become waves. All that is done
/// to a field is linear in it and the same for every field, so that a relation between fields is one between their
/// waves.
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
