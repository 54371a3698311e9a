// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/nc_grid.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/cf_projection.hpp"
#include "postprocess/maps/netcdf.hpp"

namespace talus::postprocess {
namespace {

void fill_axis(Nc& nc, const NcAxis& axis, int count, double start, double cell) {
  std::vector<double> centres, bounds;
  for (int i = 0; i < count; ++i) {
    centres.push_back(start + (i + 0.5) * cell);
    bounds.insert(bounds.end(), {start + i * cell, start + (i + 1) * cell});
  }
  nc.put(axis.variable, centres);
  nc.put(axis.bounds, bounds);
}

}  // namespace

NcAxes define_axes(Nc& nc, const MapGrid& grid) {
  NcAxes axes;
  axes.y.dimension = nc.dimension("y", static_cast<std::size_t>(grid.rows));
  axes.x.dimension = nc.dimension("x", static_cast<std::size_t>(grid.columns));
  const int sides = nc.dimension("bnds", 2);
  for (const bool is_x : {true, false}) {
    auto& [dimension, variable, bounds] = is_x ? axes.x : axes.y;
    variable = nc.variable(is_x ? "x" : "y", NC_DOUBLE, {dimension});
    bounds = nc.variable(is_x ? "x_bnds" : "y_bnds", NC_DOUBLE, {dimension, sides});
    nc.text(variable, "standard_name", is_x ? "projection_x_coordinate" : "projection_y_coordinate");
    nc.text(variable, "long_name", is_x ? "easting of the cell centre" : "northing of the cell centre");
    nc.text(variable, "units", "m");
    nc.text(variable, "axis", is_x ? "X" : "Y");
    nc.text(variable, "bounds", is_x ? "x_bnds" : "y_bnds");
  }
  return axes;
}

void define_crs(Nc& nc, const MapGrid& grid) {
  const int id = nc.variable("crs", NC_INT, {});
  const auto projection = cf_projection(grid.crs_wkt);
  nc.text(id, "long_name", "coordinate reference system");
  if (!projection.grid_mapping_name.empty()) nc.text(id, "grid_mapping_name", projection.grid_mapping_name);
  for (const auto& [name, words] : projection.words) nc.text(id, name.c_str(), words);
  for (const auto& [name, values] : projection.numbers) nc.numbers(id, name.c_str(), values);
  nc.text(id, "crs_wkt", grid.crs_wkt);
  nc.text(id, "spatial_ref", grid.crs_wkt);  // GDAL's name for it
  nc.text(id, "GeoTransform", fmt::format("{} {} 0 {} 0 {}", grid.west, grid.cell, grid.north(), -grid.cell));
}

int define_time(Nc& nc, int dimension, const std::string& start) {
  const int id = nc.variable("time", NC_DOUBLE, {dimension});
  nc.text(id, "standard_name", "time");
  nc.text(id, "long_name", "time since the start of the failure");
  nc.text(id, "units", "seconds since " + (start.empty() ? std::string(nominal_start) : start));
  nc.text(id, "calendar", "standard");
  nc.text(id, "axis", "T");
  return id;
}

void fill_axes(Nc& nc, const NcAxes& axes, const MapGrid& grid) {
  fill_axis(nc, axes.x, grid.columns, grid.west, grid.cell);
  fill_axis(nc, axes.y, grid.rows, grid.south, grid.cell);
}

std::string nc_name(const std::string& name) {
  std::string word = file_word(name);
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == '-' || c == '.'; }, '_');
  return word;
}

}  // namespace talus::postprocess
