// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two surveys brought onto one another where nothing moved.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// How residuals are spread [m].
struct Residuals {
  double median = 0, nmad = 0, rmse = 0, median_absolute = 0;
  std::size_t count = 0;
};

/// How the later survey lies on the earlier one, and how well that is known.
struct Coregistration {
  bool known = false;            ///< false: too little stable ground, or most of it changed
  Placement placement;           ///< of the later survey
  Residuals unaligned, aligned;  ///< after less before on stable ground [m]
  int iterations = 0;
  bool converged = false;
  bool shift_known = true;  ///< false on ground too level, or sloping one way only, to tell a horizontal shift
  std::array<double, 2> shift_error{};  ///< standard errors of the shift east and north [m]; 0 where it is not known
  double stable_share = 0;              ///< of the cells that both surveys hold
};

inline constexpr std::size_t least_cells = 100;

/// Shift, vertical offset and (if asked for) tilt of the later survey, found on stable ground after Nuth & Kaeaeb
/// (2011), The Cryosphere 5, 271: the misfit of a shifted surface is the scalar product of shift and slope,
///   dh = dx dz/dx + dy dz/dy - dz - (tilt),
/// their eq. 2 times tan(slope), so that level ground weighs nothing instead of infinitely much. Fitted by least
/// squares with Tukey's biweights on the NMAD, the later survey resampled anew (six-point Lagrange) at every
/// iteration, until it moves by less than a thousandth of a cell; then the shift again with each band of wavelengths
/// weighed by its noise (see refined_shift()). Starts from the whole-cell shift of least NMAD within 16 cells. In
/// between, connected cells that changed by more than three NMAD are taken out of the stable ground, so that an
/// unmapped slide does not pull. A tilt smaller than three times its error is left out, and so is a correction that
/// raises NMAD or median size of the misfit of the stable cells, but for the height. Throws DataError where heights
/// look like feet. Not known where fewer than least_cells are stable, or where changes take more than half of what is
/// neither steep nor rough nor in a polygon.
Coregistration coregister(std::vector<Patch>& patches, bool tilt, const std::filesystem::path& after_file);

}  // namespace talus::preprocess
