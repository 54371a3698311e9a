// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of maps in a NetCDF file: coordinates, their bounds, and the CRS.
#pragma once

#include "common/map/raster.hpp"
#include "postprocess/maps/nc_file.hpp"

namespace talus::postprocess {

/// An axis of the grid in the file.
struct NcAxis {
  int dimension = -1, variable = -1, bounds = -1;
};
/// Both axes.
struct NcAxes {
  NcAxis x, y;
};

/// Defines dimensions y and x with their coordinates and bounds.
NcAxes define_axes(Nc& nc, const MapGrid& grid);

/// Defines the variable crs, by the names of CF and those of GDAL.
void define_crs(Nc& nc, const MapGrid& grid);

/// Defines the variable time, in seconds since `start`; empty: not known, a nominal date stands for it.
int define_time(Nc& nc, int dimension, const std::string& start);

/// Writes coordinates and bounds.
void fill_axes(Nc& nc, const NcAxes& axes, const MapGrid& grid);

/// Letters, digits and underscores, as CF asks of names.
std::string nc_name(const std::string& name);

}  // namespace talus::postprocess
