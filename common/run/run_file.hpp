// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5: what talus-solve hands to talus-postprocess.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/run/map_fields.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"

namespace talus {
namespace h5 {
class File;
/// Switches off HDF5's file locks and its clean-up at exit. Every file of this project calls the function; a program
/// that uses GDAL before, whose drivers call HDF5, calls it first.
void prepare_library();
}  // namespace h5

/// The numbers of a run's sanity, NaN where they were not measured or nothing bounds them.
struct RunSanity {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double volume_error = unknown;  ///< volume in the domain and out of it over that at the start, less one [-]
  double volume_left = unknown;   ///< volume that left the domain over that at the start [-]
  double packing_p99 = unknown;   ///< largest over time: 99 % of the volume is packed no denser [-]
  double packing_max = unknown;   ///< largest over time of any cell [-]
  double energy_gain = unknown;   ///< largest rise of the mechanical energy over what was turned over [-]
  double speed_max = unknown;     ///< of any point at any time [m/s]
  double speed_bound = unknown;   ///< of a fall without loss from the highest point to the lowest ground reached [m/s]
  std::string words;              ///< "sane", or what is not
};

/// Where one of the numbers stands.
using SanityMember = double RunSanity::*;

/// One of the numbers, wherever it goes.
struct SanityNumber {
  const char* name;  ///< in run.h5 and score.json
  SanityMember value;
  const char* label;  ///< in score.txt and the report
  const char* unit;
  int decimals;
  const char* missing;  ///< why it may not be known
};

/// The numbers, in the order in which they are written.
inline constexpr SanityNumber sanity_numbers[] = {
    {"sanity_volume_error", &RunSanity::volume_error,
     "volume in the domain and out of it over that at the start, less 1", "", 12, "not measured"},
    {"sanity_volume_left", &RunSanity::volume_left, "volume that left the domain over that at the start", "", 4,
     "not measured"},
    {"sanity_packing_p99", &RunSanity::packing_p99, "packing that 99 % of the volume stays below", "", 2,
     "not measured"},
    {"sanity_packing_max", &RunSanity::packing_max, "densest packing", "", 2, "not measured"},
    {"sanity_energy_gain", &RunSanity::energy_gain, "largest rise of the energy over what was turned over", "", 4,
     "loads or walls that move do work on the mass"},
    {"sanity_speed_max_m_s", &RunSanity::speed_max, "fastest point", "m/s", 1, "not measured"},
    {"sanity_speed_bound_m_s", &RunSanity::speed_bound, "speed of a fall without loss", "m/s", 1,
     "loads or walls that move do work on the mass"},
};

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
  const HistoryColumn* find(const std::string& name) const;  ///< the column of this name, null where there is none
  HistoryColumn& at(const std::string& name);                ///< the column of this name, which must be there
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

/// Datasets of frames of thickness, and the attribute of / that says which run a part belongs to.
inline constexpr const char *frame_times = "/frames/time", *frame_thickness = "/frames/thickness", *run_mark = "run_id";

/// Writes run.h5, aside until finish(). Group VTKHDF (UnstructuredGrid of vertices, Steps) holds the points so that
/// ParaView opens the file as it is; groups maps, frames, history and attributes of / hold the rest.
/// Every failed HDF5 call (disk full) is a DataError.
class RunWriter {
 public:
  explicit RunWriter(std::filesystem::path file);
  ~RunWriter();
  void append(const PointFrame& frame);  ///< writes the points of one frame
  /// Writes the thickness at one time [m]; all frames are on one grid (std::logic_error otherwise).
  void append_thickness(double time, const MapGrid& grid, const std::vector<double>& thickness);
  /// Closes the file with its frames alone, as a part of the run of this id, and gives it this name, in a folder of the
  /// same file system. Throws DataError.
  void end_part(const std::filesystem::path& part, const std::string& id);
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

/// The provenance of a run. Throws DataError: missing, damaged.
Facts run_facts(const std::filesystem::path& file);

/// Makes the group and writes every column. Throws DataError when the file cannot take it.
void write_history(h5::File& file, const RunHistory& history);

/// Reads the columns in the order they were written; files older than the attributes give empty words. Throws DataError
/// when the group is missing or its columns differ in length.
RunHistory read_history(const h5::File& file);

}  // namespace talus
