// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes on maps of the driver's own making: ground and release as GeoTIFFs beside the runs.
#pragma once

#include "common/gis/geotiff.hpp"
#include "tests/validation/bench.hpp"

namespace talus::validation {

/// A grid, and how steps are taken on it.
struct Way {
  const char* name;
  const char* mapping;
  const char* integrator;
};
inline constexpr Way ways[] = {{"terrain-following", "terrain-following", "explicit"},
                               {"cartesian", "cartesian", "explicit"},
                               {"terrain-following, column-implicit", "terrain-following", "column-implicit"}};

/// The way, on cells and layers of these sizes [m].
inline Overrides overrides_of(const Way& way, double cell, double layer) {
  return {{"preprocess.grid.spacing_m", cell},
          {"preprocess.grid.layer_height_m", layer},
          {"solve.mapping", words(way.mapping)},
          {"solve.integrator", words(way.integrator)}};
}

/// value(x, y) at the centre of every cell.
template <class Value>
Raster at_centres(const MapGrid& grid, Value value) {
  Raster raster{grid, std::vector<double>(grid.count())};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) raster.at(column, row) = value(grid.x(column), grid.y(row));
  return raster;
}

/// The mean of value(x, y) over 8 x 8 places of every cell.
template <class Value>
Raster cell_means(const MapGrid& grid, Value value) {
  constexpr int parts = 8;
  return at_centres(grid, [&](double x, double y) {
    double sum = 0;
    for (int p = 0; p < parts * parts; ++p) {
      const double dx = ((p % parts) + 0.5) / parts - 0.5, dy = ((p / parts) + 0.5) / parts - 0.5;
      sum += value(x + dx * grid.cell, y + dy * grid.cell);
    }
    return sum / (parts * parts);
  });
}

/// Writes OUT/CASE/ground-PLACE.tif and release-PLACE.tif; returns what names them in a recipe of base and one release.
inline Overrides write_scene(const Bench& bench, const std::string& place, const Raster& ground,
                             const Raster& thickness) {
  const auto folder = bench.request().out / bench.name();
  std::filesystem::create_directories(folder);
  const auto ground_file = folder / ("ground-" + place + ".tif"), release_file = folder / ("release-" + place + ".tif");
  write_geotiff(ground_file, ground, {"ground", "m", {}});
  write_geotiff(release_file, thickness, {"thickness, vertical", "m", {}});
  return {{"preprocess.base_dem", words(ground_file.string())},
          {"preprocess.release[0].thickness_raster", words(release_file.string())}};
}

}  // namespace talus::validation
