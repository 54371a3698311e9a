// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/vtkhdf.hpp"

#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace talus {
namespace {

constexpr std::uint8_t vtk_vertex = 1;
const std::string root = "/VTKHDF";
const std::string steps_group = root + "/Steps";
constexpr const char* fields[] = {"velocity", "volume", "pressure", "id", "release"};

void check_lengths(const PointFrame& frame) {
  const auto n = frame.position.size();
  if (frame.velocity.size() != n || frame.volume.size() != n || frame.pressure.size() != n || frame.id.size() != n ||
      frame.release.size() != n) {
    throw std::logic_error("PointFrame: columns of different lengths");
  }
}

template <class T, std::size_t N>
std::span<const T> flat(const std::vector<std::array<T, N>>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * N};
}

template <class T>
std::span<const T> flat(const std::vector<T>& values) {
  return values;
}

}  // namespace

VtkHdfPoints::VtkHdfPoints(h5::File& file) : file_(file) {
  file_.make_group(root);
  constexpr std::int64_t layout_version[] = {2, 0};
  file_.set_integers(root, "Version", layout_version);
  file_.set_text(root, "Type", "UnstructuredGrid");
  for (const auto* group : {"/PointData", "/CellData", "/Steps", "/Steps/PointDataOffsets", "/Steps/CellDataOffsets"}) {
    file_.make_group(root + group);
  }
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

}  // namespace talus
