// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Group VTKHDF of run.h5: material points as an UnstructuredGrid of vertices over time.
#pragma once

#include <cstdint>

#include "common/run/hdf5.hpp"
#include "common/run/run_file.hpp"

namespace talus {

/// Writes the points of one frame after another in the layout "VTKHDF" version 2.0 (Kitware, VTK file formats: VTKHDF,
/// UnstructuredGrid with Steps): one part per step, data of all steps end to end, found again by offsets.
class VtkHdfPoints {
 public:
  explicit VtkHdfPoints(h5::File& file);  ///< makes the groups
  /// Writes the points of one frame.
  void append(const PointFrame& frame);
  void finish();  ///< writes the number of steps

 private:
  void append_cells(std::int64_t count);
  void append_steps(double time, std::int64_t count);

  h5::File& file_;
  std::int64_t steps_ = 0, points_ = 0;  // written so far
};

}  // namespace talus
