// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Frames in files: one each in a folder of their own while the run goes on, so that a run broken off and resumed ends
// with the same run.h5.
#pragma once

#include <filesystem>

#include "common/run/run_file.hpp"

namespace talus::solver {

/// A folder of frames by number, in a folder for every run, so that those of an older run stay until they are dropped.
class FrameStore {
 public:
  explicit FrameStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// From now on frames are those of this run; each carries its id. Empty: of a version that knew no ids.
  void belong_to(const std::string& run_id) { run_id_ = run_id; }
  void clear();              ///< drops all frames, of whichever run
  void drop_others() const;  ///< drops the frames of other runs
  /// The method writes one frame, aside and renamed at the end. It throws DataError (disk full, not writable).
  void put(std::int64_t number, const PointFrame& points, const MapGrid& grid, const std::vector<double>& thickness);
  /// The method throws DataError unless frames 0 .. count-1 are there.
  void expect(std::int64_t count) const;
  /// The method hands frame `number` to the run file. It throws DataError when it is missing or another run's.
  void append_to(RunWriter& run, std::int64_t number, const MapGrid& grid) const;

 private:
  std::filesystem::path file(std::int64_t number) const;
  std::filesystem::path folder_;
  std::string run_id_ = {};
};

}  // namespace talus::solver
