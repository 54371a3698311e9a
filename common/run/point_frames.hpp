// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The material points in run.h5, read back frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus {
namespace h5 {
class File;
}

/// The frames of points in a file that read_run() has read (and so checked its seal).
class PointFrames {
 public:
  /// Opens the file. A run without points (point_frames = false) has no frames, or frames of 0 points. Throws DataError
  /// where the file cannot be read, or its lists do not go together.
  explicit PointFrames(const std::filesystem::path& run_file);
  ~PointFrames();

  /// Times of the frames [s], rising.
  const std::vector<double>& time() const { return time_; }
  /// Points of a frame.
  std::size_t points(std::size_t frame) const { return static_cast<std::size_t>(count_.at(frame)); }
  /// The most points that a frame has; 0 in a run without points.
  std::size_t most_points() const;
  /// The points of all frames together.
  std::size_t all_points() const;
  /// Reads one frame; positions in map coordinates and elevation [m]. Throws DataError: numbers that cannot be.
  PointFrame read(std::size_t frame) const;

 private:
  std::unique_ptr<h5::File> file_;
  std::vector<double> time_;
  std::vector<std::int64_t> count_, first_;
};

}  // namespace talus
