// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains of the preprocess tests: random ones, with the seed printed, and files made of them.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "common/gis/geotiff.hpp"
#include "common/map/raster.hpp"
#include "common/map/sum.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// A seed that changes from run to run; TALUS_TEST_SEED repeats one.
inline unsigned test_seed() {
  const char* fixed = std::getenv("TALUS_TEST_SEED");
  return fixed ? static_cast<unsigned>(std::strtoul(fixed, nullptr, 10)) : std::random_device{}();
}
#define TALUS_SEEDED(seed)                          \
  const unsigned seed = ::talus::test::test_seed(); \
  SCOPED_TRACE("TALUS_TEST_SEED=" + std::to_string(seed))

inline MapGrid grid_of(int columns, int rows, double cell, double west = 500000, double south = 5100000) {
  MapGrid grid;
  grid.columns = columns;
  grid.rows = rows;
  grid.cell = cell;
  grid.west = west;
  grid.south = south;
  return grid;
}

template <class Value>
Raster raster_of(const MapGrid& grid, Value value) {
  Raster raster{grid, std::vector<double>(grid.count())};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) raster.at(column, row) = value(grid.x(column), grid.y(row));
  }
  return raster;
}

/// Hills and hollows of random place, width and height, on a slope.
class Hills {
 public:
  Hills(const MapGrid& grid, std::mt19937& random) {
    std::uniform_real_distribution<double> part(0, 1);
    const double width = grid.columns * grid.cell, height = grid.rows * grid.cell;
    for (int i = 0; i < 12; ++i) {
      hills_.push_back({grid.west + width * part(random), grid.south + height * part(random),
                        (0.05 + 0.2 * part(random)) * width, 40 * (part(random) - 0.4)});
    }
    fall_x_ = part(random) - 0.5;
    fall_y_ = part(random) - 0.5;
    west_ = grid.west;
    south_ = grid.south;
  }
  double operator()(double x, double y) const {
    double z = 1000 + fall_x_ * (x - west_) + fall_y_ * (y - south_);
    for (const Hill& h : hills_)
      z += h.height * std::exp(-(std::pow(x - h.x, 2) + std::pow(y - h.y, 2)) / (h.width * h.width));
    return z;
  }

 private:
  struct Hill {
    double x, y, width, height;
  };
  std::vector<Hill> hills_;
  double fall_x_ = 0, fall_y_ = 0, west_ = 0, south_ = 0;
};

inline double volume_of(const Raster& thickness) {
  Sum sum;
  for (double t : thickness.values) sum.add(t);
  return sum.value() * thickness.grid.cell * thickness.grid.cell;
}

inline std::filesystem::path write(const Scratch& scratch, const std::string& name, const Raster& raster) {
  write_geotiff(scratch / name, raster, {});
  return scratch / name;
}

/// A GeoJSON without CRS text of its own would be in degrees, so polygons are written as CSV with WKT, which names
/// none.
inline std::filesystem::path write_polygon(const Scratch& scratch, const std::string& name, const std::string& wkt,
                                           const std::string& columns = ",id", const std::string& values = ",1") {
  return scratch.write(name, "WKT" + columns + "\n\"" + wkt + "\"" + values + "\n");
}

}  // namespace talus::test
