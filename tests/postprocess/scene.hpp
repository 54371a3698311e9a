// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small run for the tests: a slope of 40 x 30 cells falling to the east, a release at its top, a deposit at its foot.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

inline const char* utm32n =
    "PROJCRS[\"WGS 84 / UTM zone 32N\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\","
    "ELLIPSOID[\"WGS 84\",6378137,298.257223563,LENGTHUNIT[\"metre\",1]]],PRIMEM[\"Greenwich\",0,"
    "ANGLEUNIT[\"degree\",0.0174532925199433]],ID[\"EPSG\",4326]],CONVERSION[\"UTM zone 32N\","
    "METHOD[\"Transverse Mercator\",ID[\"EPSG\",9807]],"
    "PARAMETER[\"Latitude of natural origin\",0,ANGLEUNIT[\"degree\",0.0174532925199433],ID[\"EPSG\",8801]],"
    "PARAMETER[\"Longitude of natural origin\",9,ANGLEUNIT[\"degree\",0.0174532925199433],ID[\"EPSG\",8802]],"
    "PARAMETER[\"Scale factor at natural origin\",0.9996,SCALEUNIT[\"unity\",1],ID[\"EPSG\",8805]],"
    "PARAMETER[\"False easting\",500000,LENGTHUNIT[\"metre\",1],ID[\"EPSG\",8806]],"
    "PARAMETER[\"False northing\",0,LENGTHUNIT[\"metre\",1],ID[\"EPSG\",8807]]],CS[Cartesian,2],"
    "AXIS[\"(E)\",east,ORDER[1],LENGTHUNIT[\"metre\",1]],AXIS[\"(N)\",north,ORDER[2],LENGTHUNIT[\"metre\",1]],"
    "ID[\"EPSG\",32632]]";

inline MapGrid small_grid() {
  return {.columns = 40, .rows = 30, .west = 600000, .south = 5100000, .cell = 10, .crs_wkt = utm32n};
}

/// `height` in columns [from, to) of rows [bottom, top), 0 elsewhere.
inline std::vector<double> block(const MapGrid& grid, int from, int to, int bottom, int top, double height) {
  std::vector<double> values(grid.count(), 0.0);
  for (int row = bottom; row < top; ++row)
    for (int column = from; column < to; ++column) values[grid.index(column, row)] = height;
  return values;
}

/// Two records of a column of each kind.
inline RunHistory small_history() {
  return {{{"time_s", "s", "", "", {0, 1}},
           {"kinetic_J", "J", "", "", {5, 6}},
           {"gauge_a_thickness_m", "m", "thickness", "gauge a", {7, 8}},
           {"volume_m3", "m3", "", "", {7, 8}},
           {"speed_max_m_s", "m s-1", "", "", {7, 8}},
           {"momentum_x_kg_m_s", "kg m s-1", "", "", {-7, 8}},
           {"newton_iterations", "1", "", "", {7, 8}}}};
}

/// Release: columns 3-6, rows 10-19, 6 m. Deposit: columns 25-34, rows 10-19, 2.4 m with a thicker core. The two
/// southernmost rows lie outside the domain.
inline Run small_run() {
  Run run;
  auto& maps = run.maps;
  maps.grid = small_grid();
  const auto& grid = maps.grid;
  maps.initial_thickness = block(grid, 3, 7, 10, 20, 6.0);
  maps.deposit_thickness = block(grid, 25, 35, 10, 20, 1.5);
  const auto core = block(grid, 28, 31, 12, 18, 5.0);
  maps.peak_thickness = block(grid, 3, 35, 10, 20, 3.0);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = grid.index(column, row);
      maps.terrain.push_back(row < 2 ? nan : 1000 - 5.0 * column + 0.5 * row + 3 * std::sin(0.8 * row));
      maps.before.push_back(maps.terrain[i] + maps.initial_thickness[i]);
      maps.deposit_thickness[i] += core[i];
      maps.peak_speed.push_back(maps.peak_thickness[i] > 0 ? 20 : 0);
      maps.peak_pressure_kPa.push_back(maps.peak_thickness[i] > 0 ? 880 : 0);
      maps.arrival_time.push_back(maps.peak_thickness[i] > 0 ? 0.5 * column : nan);
    }
  }
  maps.threshold = 0.1;
  run.frames = {{0, 20}, {maps.initial_thickness, maps.deposit_thickness}};
  auto& s = run.summary;
  s.scene = "small";
  s.title = "Small slope";
  s.on = "cpu";
  s.precision = "double";
  s.version = "0.0.0 (test)";
  s.stop_reason = "end time";
  s.material = "an elastic material";
  s.bed = "no friction";
  s.particles = 320;
  s.steps = 77;
  s.time_end = 20;
  s.wall_time = 0.25;
  s.density = 2200;
  s.volume_released = 6.0 * 40 * 100;             // 24 000 m3
  s.volume_final = (1.5 * 100 + 5.0 * 18) * 100;  // 24 000 m3
  return run;
}

/// The terrain as a plane that falls 3 m over 4 m to the east: the cosine of its slope is 0.8 to the last digits.
inline void tilt(RunMaps& maps, int from_row = 0) {
  for (int row = from_row; row < maps.grid.rows; ++row)
    for (int column = 0; column < maps.grid.columns; ++column)
      maps.terrain[maps.grid.index(column, row)] = 1000 - 7.5 * column;
}

inline void write_run(const std::filesystem::path& file, const Run& run) {
  RunWriter writer(file);
  PointFrame frame;
  frame.position = {{600050, 5100150, 990}};
  frame.velocity = {{1, 0, 0}};
  frame.volume = {1};
  frame.pressure = {0};
  frame.id = {0};
  frame.release = {0};
  writer.append(frame);
  for (std::size_t i = 0; i < run.frames.time.size(); ++i)
    writer.append_thickness(run.frames.time[i], run.maps.grid, run.frames.thickness[i]);
  writer.finish(run.maps, run.history, run.summary);
}

}  // namespace talus::test
