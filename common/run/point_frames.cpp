// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/point_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

#include "common/run/hdf5.hpp"
#include "common/run/sealed_file.hpp"

namespace talus {
namespace {

constexpr std::uint8_t vtk_vertex = 1;
const std::string root = "/VTKHDF";
const std::string steps_group = root + "/Steps";
constexpr const char* fields[] = {"velocity", "volume", "pressure", "id", "release"};

constexpr h5::Allowed a_velocity{.low = -limits::speed, .high = limits::speed};
constexpr h5::Allowed a_place{.low = -limits::coordinate, .high = limits::coordinate};

void check_lengths(const PointFrame& frame) {
  const auto n = frame.position.size();
  if (frame.velocity.size() != n || frame.volume.size() != n || frame.pressure.size() != n || frame.id.size() != n ||
      frame.release.size() != n)
    throw std::logic_error("PointFrame: columns of different lengths");
}

template <class T, std::size_t N>
std::span<const T> flat(const std::vector<std::array<T, N>>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * N};
}

template <class T>
std::span<const T> flat(const std::vector<T>& values) {
  return values;
}

/// Rows of N numbers each, flat, as arrays.
template <class T, std::size_t N>
std::vector<std::array<T, N>> rows_of(const std::vector<T>& flat) {
  std::vector<std::array<T, N>> rows(flat.size() / N);
  if (!rows.empty()) std::memcpy(rows.data(), flat.data(), rows.size() * sizeof rows[0]);
  return rows;
}

}  // namespace

VtkHdfPoints::VtkHdfPoints(h5::File& file) : file_(file) {
  file_.make_group(root);
  constexpr std::int64_t layout_version[] = {2, 0};
  file_.set_integers(root, "Version", layout_version);
  file_.set_text(root, "Type", "UnstructuredGrid");
  for (const auto* group : {"/PointData", "/CellData", "/Steps", "/Steps/PointDataOffsets", "/Steps/CellDataOffsets"})
    file_.make_group(root + group);
}

void VtkHdfPoints::append(const PointFrame& frame) {
  check_lengths(frame);
  const auto n = frame.position.size();
  append_steps(frame.time, static_cast<std::int64_t>(n));
  append_cells(static_cast<std::int64_t>(n));
  file_.append<double>(root + "/Points", n, {3}, flat(frame.position));
  const auto data = root + "/PointData/";
  file_.append<float>(data + "velocity", n, {3}, flat(frame.velocity));
  file_.append<float>(data + "volume", n, {}, flat(frame.volume));
  file_.append<float>(data + "pressure", n, {}, flat(frame.pressure));
  file_.append<std::int32_t>(data + "id", n, {}, flat(frame.id));
  file_.append<std::int32_t>(data + "release", n, {}, flat(frame.release));
  points_ += static_cast<std::int64_t>(n);
  ++steps_;
}

/// One vertex per point. Offsets hold count + 1 numbers per part, hence one more per step than there are cells.
void VtkHdfPoints::append_cells(std::int64_t count) {
  const auto n = static_cast<std::size_t>(count);
  std::vector<std::int64_t> ids(n + 1);
  std::iota(ids.begin(), ids.end(), 0);
  const std::span<const std::int64_t> all(ids);
  file_.append<std::int64_t>(root + "/Connectivity", n, {}, all.first(n));
  file_.append<std::int64_t>(root + "/Offsets", n + 1, {}, all);
  file_.append<std::uint8_t>(root + "/Types", n, {}, std::vector<std::uint8_t>(n, vtk_vertex));
}

void VtkHdfPoints::append_steps(double time, std::int64_t count) {
  const auto one = [&](const std::string& path, std::int64_t value) {
    file_.append<std::int64_t>(path, 1, {}, std::span<const std::int64_t>(&value, 1));
  };
  for (const auto* name : {"/NumberOfPoints", "/NumberOfCells", "/NumberOfConnectivityIds"}) one(root + name, count);
  file_.append<double>(steps_group + "/Values", 1, {}, std::span<const double>(&time, 1));
  one(steps_group + "/PartOffsets", steps_);
  one(steps_group + "/NumberOfParts", 1);
  for (const auto* name : {"/PointOffsets", "/CellOffsets", "/ConnectivityIdOffsets"}) one(steps_group + name, points_);
  for (const auto* field : fields) one(steps_group + "/PointDataOffsets/" + field, points_);
}

void VtkHdfPoints::finish() { file_.set_integer(steps_group, "NSteps", steps_); }

PointFrames::PointFrames(const std::filesystem::path& run_file)
    : file_(std::make_unique<h5::File>(h5::File::open(run_file, {run_file, "Run talus-solve again"}))) {
  if (!file_->exists(root + "/Steps/Values") || !file_->exists(root + "/PointData/velocity")) return;
  time_ = file_->read_list<double>(root + "/Steps/Values");
  h5::check_growing(*file_, root + "/Steps/Values", time_, h5::a_time);
  const auto all = static_cast<double>(file_->dims(root + "/PointData/velocity").at(0));
  count_ = file_->read<std::int64_t>(root + "/NumberOfPoints", {time_.size()}, {.low = 0, .high = all});
  first_ = file_->read<std::int64_t>(root + "/Steps/PointOffsets", {time_.size()}, {.low = 0, .high = all});
}

PointFrames::~PointFrames() = default;

std::size_t PointFrames::most_points() const {
  return count_.empty() ? 0 : static_cast<std::size_t>(*std::max_element(count_.begin(), count_.end()));
}

std::size_t PointFrames::all_points() const {
  return static_cast<std::size_t>(std::accumulate(count_.begin(), count_.end(), std::int64_t{0}));
}

std::array<double, 2> PointFrames::moving(std::size_t frame, double faster_than) const {
  constexpr hsize_t rows_at_once = 1 << 20;
  const auto first = static_cast<hsize_t>(first_.at(frame)), count = static_cast<hsize_t>(count_.at(frame));
  double volume = 0, flux = 0;
  for (hsize_t done = 0; done < count; done += rows_at_once) {
    const hsize_t rows = std::min(rows_at_once, count - done);
    const auto velocity = file_->read_rows<float>(root + "/PointData/velocity", first + done, rows, {3}, a_velocity);
    const auto volumes = file_->read_rows<float>(root + "/PointData/volume", first + done, rows, {}, h5::a_volume);
    for (std::size_t p = 0; p < volumes.size(); ++p) {
      const double speed = std::hypot(velocity[3 * p], velocity[3 * p + 1], velocity[3 * p + 2]);
      if (!(speed > faster_than)) continue;
      volume += volumes[p];
      flux += speed * volumes[p];
    }
  }
  return {volume, volume > 0 ? flux / volume : 0};
}

PointFrame PointFrames::read(std::size_t frame) const {
  const auto first = static_cast<hsize_t>(first_.at(frame)), count = static_cast<hsize_t>(count_.at(frame));
  PointFrame points;
  points.time = time_.at(frame);
  points.position = rows_of<double, 3>(file_->read_rows<double>(root + "/Points", first, count, {3}, a_place));
  points.velocity =
      rows_of<float, 3>(file_->read_rows<float>(root + "/PointData/velocity", first, count, {3}, a_velocity));
  points.volume = file_->read_rows<float>(root + "/PointData/volume", first, count, {}, h5::a_volume);
  points.pressure = file_->read_rows<float>(root + "/PointData/pressure", first, count, {}, h5::finite);
  points.id = file_->read_rows<std::int32_t>(root + "/PointData/id", first, count, {}, h5::not_negative);
  points.release = file_->read_rows<std::int32_t>(root + "/PointData/release", first, count, {}, h5::not_negative);
  return points;
}

}  // namespace talus
