// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Styles for QGIS beside rasters: NAME.qml beside NAME.tif is applied by QGIS when the raster is opened.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "common/map/colours.hpp"

namespace talus {

/// Values up to `upper` (and above the class before).
struct StyleClass {
  double upper = std::numeric_limits<double>::infinity();
  Colour colour;
  std::string label;
};

/// A raster drawn in classes.
struct RasterStyle {
  std::vector<StyleClass> classes;  ///< rising; the last without end
  double hidden_from = 0;           ///< values from here ...
  double hidden_to = 0;             ///< ... to here are not drawn; nothing is hidden where both are the same
  double opacity = 1;               ///< 0 to 1
  int band = 1;                     ///< of the raster, from 1
};

/// Polygons drawn by their outlines.
struct OutlineStyle {
  Colour colour;
  double width_mm = 0.5;  ///< on paper
  bool dashed = false;
};

/// Classes by their rising lower limits, the last without end; what lies below the first is not drawn. Labels carry the
/// unit: "5 - 10 m".
RasterStyle class_style(const std::vector<double>& limits, const std::string& unit, Ramp ramp = Ramp::heat);

/// Classes of a quantity whose early or small values count most (an arrival time), by their rising limits: dark first,
/// and all values drawn.
RasterStyle time_style(const std::vector<double>& limits, const std::string& unit);

/// Classes of a difference, symmetric about zero: losses blue, gains red, by the rising positive `limits`; what is
/// smaller than the first of them is not drawn.
RasterStyle difference_style(const std::vector<double>& limits, const std::string& unit);

/// Write the style of `raster_file` (band 1) beside it, as NAME.qml for QGIS 3. Returns its path. Throws DataError
/// (disk full).
std::filesystem::path write_qgis_style(const std::filesystem::path& raster_file, const RasterStyle& style);

/// Write the style of a terrain beside its raster: a grey hillshade lit from four sides. Returns its path. Throws
/// DataError (disk full).
std::filesystem::path write_qgis_hillshade_style(const std::filesystem::path& raster_file);

}  // namespace talus
