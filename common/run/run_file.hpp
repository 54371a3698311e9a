// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5: what talus-solve hands to talus-postprocess. HDF5 stays behind run_file.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/places.hpp"
#include "common/run/map_fields.hpp"
#include "common/run/run_sanity.hpp"
#include "common/stage/findings.hpp"

namespace talus {

/// Thickness maps over time.
struct RunFrames {
  std::vector<double> time;                    // [s]
  std::vector<std::vector<double>> thickness;  // one map per time [m]
};

/// One number of the run over time.
struct HistoryColumn {
  std::string name;            ///< with its unit: "time_s", "kinetic_J", ...
  std::string unit;            ///< as maps have it: "J", "m s-1", "1" for a number of things
  std::string quantity;        ///< what is measured at a place ("thickness"); empty for a number of the whole run
  std::string place;           ///< where ("gauge bridge"); empty for a number of the whole run
  std::vector<double> values;  ///< [records]
};

/// Columns of equal length, one row per record.
struct RunHistory {
  std::vector<HistoryColumn> columns;
  /// The column of this name, null where there is none.
  const HistoryColumn* find(const std::string& name) const;
  /// The column of this name, which must be there.
  HistoryColumn& at(const std::string& name);
  const HistoryColumn& at(const std::string& name) const;
};

/// One number or word each; names as in score.json where they meet.
struct RunSummary {
  std::string scene, title, on, precision, version, stop_reason;
  std::string material, bed;  // their laws in words: "It is ...", "at its bed acts ..."; empty in older files
  std::int64_t particles = 0, particles_outflow = 0, steps = 0;
  double time_end = 0;                                    // [s]
  double wall_time = 0;                                   // step loop [s]
  double memory = 0;                                      // points, grid and linear solver, at the end [bytes]
  double density = 0;                                     // [kg/m3]
  std::vector<double> release_density;                    // of each release [kg/m3]; empty in older files
  double layer_height = 0;                                // of the background grid [m]; 0 in older files
  double volume_released = 0;                             // [m3]
  double volume_entrained = 0;                            // eroded from the ground on the way [m3]
  double volume_final = 0;                                // [m3]
  double volume_outflow = 0;                              // [m3]
  RunSanity sanity;                                       // what the run says of itself
  std::vector<std::pair<std::string, double>> profile;    // phases of the step loop [s]; empty unless measured
  std::vector<std::pair<std::string, double>> memory_of;  // its owners [bytes]
  std::vector<std::pair<std::string, std::string>> provenance;
  std::vector<MapPlace> places;   // of obstacles, sections, inflows and gauges
  std::vector<Finding> findings;  // of talus-preprocess, then of talus-solve
};

/// Points of one frame, for VTKHDF.
struct PointFrame {
  double time = 0;                              // [s]
  std::vector<std::array<double, 3>> position;  // map coordinates [m]
  std::vector<std::array<float, 3>> velocity;   // [m/s]
  std::vector<float> volume;                    // [m3]
  std::vector<float> pressure;                  // mean stress, compression positive [Pa]
  std::vector<std::int32_t> id, release;
};

/// Writes run.h5, aside until finish(). Group VTKHDF (UnstructuredGrid of vertices, Steps) holds the points so that
/// ParaView opens the file as it is; groups maps, frames, history and attributes of / hold the rest.
/// Every failed HDF5 call (disk full) is a DataError.
class RunWriter {
 public:
  explicit RunWriter(std::filesystem::path file);
  ~RunWriter();
  /// Writes the points of one frame.
  void append(const PointFrame& frame);
  /// Writes the thickness at one time [m]; all frames are on one grid (std::logic_error otherwise).
  void append_thickness(double time, const MapGrid& grid, const std::vector<double>& thickness);
  /// Writes the rest, closes the file and gives it its name. Throws DataError.
  void finish(const RunMaps& maps, const RunHistory& history, const RunSummary& summary);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

/// All of run.h5 but the points.
struct Run {
  RunMaps maps;
  RunFrames frames;
  RunHistory history;
  RunSummary summary;
};

/// Read everything but the points. Throws DataError:
/// missing, truncated, changed since it was written, not a run of this program, or holding what cannot be.
Run read_run(const std::filesystem::path& file);

}  // namespace talus
