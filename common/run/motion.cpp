// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/run/check_values.hpp"
#include "common/run/hdf5.hpp"

namespace talus {
namespace {

constexpr hsize_t rows_at_once = 1 << 20;

/// Adds up one frame, points [first, first + count).
void add_frame(const h5::File& file, hsize_t first, hsize_t count, double faster_than, Motion& motion) {
  double volume = 0, flux = 0;
  for (hsize_t done = 0; done < count; done += rows_at_once) {
    const hsize_t rows = std::min(rows_at_once, count - done);
    const auto velocity = file.read_rows<float>("/VTKHDF/PointData/velocity", first + done, rows, {3});
    const auto volumes = file.read_rows<float>("/VTKHDF/PointData/volume", first + done, rows, {});
    h5::check_values<float>(file, "/VTKHDF/PointData/velocity", velocity, h5::finite);
    h5::check_values<float>(file, "/VTKHDF/PointData/volume", volumes, h5::not_negative);
    for (std::size_t p = 0; p < volumes.size(); ++p) {
      const double speed = std::hypot(velocity[3 * p], velocity[3 * p + 1], velocity[3 * p + 2]);
      if (!(speed > faster_than)) continue;
      volume += volumes[p];
      flux += speed * volumes[p];
    }
  }
  motion.volume.push_back(volume);
  motion.mean_speed.push_back(volume > 0 ? flux / volume : 0);
}

}  // namespace

Motion read_motion(const std::filesystem::path& run_file, double faster_than) {
  const auto file = h5::File::open(run_file, {run_file, "Run talus-solve again"});
  Motion motion;
  if (!file.exists("/VTKHDF/Steps/Values") || !file.exists("/VTKHDF/PointData/velocity")) return motion;
  motion.time = file.read_list<double>("/VTKHDF/Steps/Values");
  h5::check_growing(file, "/VTKHDF/Steps/Values", motion.time, true);
  const auto counts = file.read<std::int64_t>("/VTKHDF/NumberOfPoints", {motion.time.size()});
  const auto offsets = file.read<std::int64_t>("/VTKHDF/Steps/PointOffsets", {motion.time.size()});
  h5::check_values<std::int64_t>(file, "/VTKHDF/NumberOfPoints", counts, h5::not_negative);
  h5::check_values<std::int64_t>(file, "/VTKHDF/Steps/PointOffsets", offsets, h5::not_negative);
  for (std::size_t i = 0; i < counts.size(); ++i)
    add_frame(file, static_cast<hsize_t>(offsets[i]), static_cast<hsize_t>(counts[i]), faster_than, motion);
  return motion;
}

}  // namespace talus
