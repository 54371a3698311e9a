// Frames in files: one each in a folder of their own while the run goes on, so that a run broken off and resumed ends
// with the same run.h5.
#pragma once

#include <filesystem>

#include "common/run/run_file.hpp"

namespace talus::solver {

/// A folder of frames by number.
class FrameStore {
 public:
  explicit FrameStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void clear();  ///< forget all frames
  /// The method writes one frame, aside and renamed at the end. It throws DataError (disk full, not writable).
  void put(std::int64_t number, const PointFrame& points, const MapGrid& grid, const std::vector<double>& thickness);
  /// The method throws DataError unless frames 0 .. count-1 are there.
  void expect(std::int64_t count) const;
  /// The method hands frames 0 .. count-1 to the run file. It throws DataError when one is missing.
  void append_to(RunWriter& run, std::int64_t count, const MapGrid& grid) const;

 private:
  std::filesystem::path file(std::int64_t number) const;
  std::filesystem::path folder_;
};

/// This function writes the points of a frame as `file` (OpenVDB PointDataGrid with velocity, volume, pressure, id),
/// for Houdini, Blender, ParaView. It throws DataError when it cannot be written.
void write_points_vdb(const std::filesystem::path& file, const PointFrame& frame, double spacing);

}  // namespace talus::solver
