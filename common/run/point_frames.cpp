// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/point_frames.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "common/run/check_values.hpp"
#include "common/run/hdf5.hpp"

namespace talus {
namespace {

const std::string vtk = "/VTKHDF";

/// Rows of N numbers each, flat, as arrays.
template <class T, std::size_t N>
std::vector<std::array<T, N>> rows_of(const std::vector<T>& flat) {
  std::vector<std::array<T, N>> rows(flat.size() / N);
  for (std::size_t i = 0; i < flat.size(); ++i) rows[i / N][i % N] = flat[i];
  return rows;
}

/// Values of the points [first, first + count), looked at before they are used.
template <class T>
std::vector<T> read_values(const h5::File& file, const std::string& name, hsize_t first, hsize_t count,
                           const h5::Dims& row, const h5::Allowed& allowed) {
  auto values = file.read_rows<T>(vtk + name, first, count, row);
  h5::check_values<T>(file, vtk + name, values, allowed);
  return values;
}

}  // namespace

PointFrames::PointFrames(const std::filesystem::path& run_file)
    : file_(std::make_unique<h5::File>(h5::File::open(run_file, {run_file, "Run talus-solve again"}))) {
  if (!file_->exists(vtk + "/Steps/Values") || !file_->exists(vtk + "/PointData/velocity")) return;
  time_ = file_->read_list<double>(vtk + "/Steps/Values");
  h5::check_growing(*file_, vtk + "/Steps/Values", time_, true);
  count_ = file_->read<std::int64_t>(vtk + "/NumberOfPoints", {time_.size()});
  first_ = file_->read<std::int64_t>(vtk + "/Steps/PointOffsets", {time_.size()});
  h5::check_values<std::int64_t>(*file_, vtk + "/NumberOfPoints", count_, h5::not_negative);
  h5::check_values<std::int64_t>(*file_, vtk + "/Steps/PointOffsets", first_, h5::not_negative);
}

PointFrames::~PointFrames() = default;

std::size_t PointFrames::most_points() const {
  return count_.empty() ? 0 : static_cast<std::size_t>(*std::max_element(count_.begin(), count_.end()));
}

std::size_t PointFrames::all_points() const {
  return static_cast<std::size_t>(std::accumulate(count_.begin(), count_.end(), std::int64_t{0}));
}

PointFrame PointFrames::read(std::size_t frame) const {
  const auto first = static_cast<hsize_t>(first_.at(frame)), count = static_cast<hsize_t>(count_.at(frame));
  PointFrame points;
  points.time = time_.at(frame);
  points.position = rows_of<double, 3>(read_values<double>(*file_, "/Points", first, count, {3}, h5::finite));
  points.velocity = rows_of<float, 3>(read_values<float>(*file_, "/PointData/velocity", first, count, {3}, h5::finite));
  points.volume = read_values<float>(*file_, "/PointData/volume", first, count, {}, h5::not_negative);
  points.pressure = read_values<float>(*file_, "/PointData/pressure", first, count, {}, h5::finite);
  points.id = read_values<std::int32_t>(*file_, "/PointData/id", first, count, {}, h5::not_negative);
  points.release = read_values<std::int32_t>(*file_, "/PointData/release", first, count, {}, h5::not_negative);
  return points;
}

}  // namespace talus
