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
#include "common/map/statistics.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// A seed that changes from run to run; TALUS_TEST_SEED repeats one.
inline unsigned test_seed() {
  const char* fixed = std::getenv("TALUS_TEST_SEED");
  return fixed ? static_cast<unsigned>(std::strtoul(fixed, nullptr, 10)) : std::random_device{}();
}
/// Random numbers from it, which a failure tells.
struct Seeded : std::mt19937 {
  explicit Seeded(unsigned of = test_seed())
      : std::mt19937(of), number(of), trace(__FILE__, __LINE__, "TALUS_TEST_SEED=" + std::to_string(of)) {}
  const unsigned number;
  const testing::ScopedTrace trace;
};

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
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) raster.at(column, row) = value(grid.x(column), grid.y(row));
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

/// Cell by cell.
inline Raster difference(const Raster& a, const Raster& b) {
  Raster result = a;
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] -= b.values[i];
  return result;
}

inline void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

/// Takes the value of all cells in a window away.
inline void punch(Raster& raster, const CellWindow& w) {
  for (int row = w.row; row < w.row + w.rows; ++row)
    for (int column = w.column; column < w.column + w.columns; ++column) raster.at(column, row) = std::nan("");
}

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

/// A rectangle as WKT.
inline std::string rectangle(double west, double south, double east, double north) {
  return fmt::format("POLYGON(({0} {1},{2} {1},{2} {3},{0} {3},{0} {1}))", west, south, east, north);
}

}  // namespace talus::test
