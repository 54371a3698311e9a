// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The material points in run.h5, written and read back frame by frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus {

/// Writes the points of one frame after another in the layout "VTKHDF" version 2.0 (Kitware, VTK file formats: VTKHDF,
/// UnstructuredGrid with Steps): one part per step, data of all steps end to end, found again by offsets.
class VtkHdfPoints {
 public:
  explicit VtkHdfPoints(h5::File& file);  ///< makes the groups
  void append(const PointFrame& frame);
  void finish();  ///< writes the number of steps

 private:
  void append_cells(std::int64_t count);
  void append_steps(double time, std::int64_t count);

  h5::File& file_;
  std::int64_t steps_ = 0, points_ = 0;  // written so far
};

/// The frames of points in a file that read_run() has read (and so checked its seal).
class PointFrames {
 public:
  /// Opens the file. A run without points has no frames, or frames of 0 points. Throws DataError where the file cannot
  /// be read, or its lists do not go together.
  explicit PointFrames(const std::filesystem::path& run_file);
  ~PointFrames();

  const std::vector<double>& time() const { return time_; }  ///< times of the frames [s], rising
  std::size_t points(std::size_t frame) const { return static_cast<std::size_t>(count_.at(frame)); }
  std::size_t most_points() const;  ///< the most points that a frame has; 0 in a run without points
  std::size_t all_points() const;   ///< the points of all frames together
  /// Of the points of a frame that are faster than this [m/s] their volume [m3], and their mean speed by volume [m/s],
  /// 0 where none moves. Reads a part at a time.
  std::array<double, 2> moving(std::size_t frame, double faster_than) const;
  /// Reads one frame; positions in map coordinates and elevation [m]. Throws DataError: numbers that cannot be.
  PointFrame read(std::size_t frame) const;

 private:
  std::unique_ptr<h5::File> file_;
  std::vector<double> time_;
  std::vector<std::int64_t> count_, first_;
};

}  // namespace talus
