// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"

namespace talus::h5 {
namespace {

/// Chunks of about 2^15 values: a good size for the cache HDF5 keeps (1 MiB) and for reading one map or one frame.
Dims chunk_of(const Dims& dims) {
  Dims chunk = dims;
  hsize_t left = 1 << 15;
  for (auto i = chunk.size(); i-- > 0;) {
    chunk[i] = std::clamp<hsize_t>(chunk[i], 1, std::max<hsize_t>(left, 1));
    left /= chunk[i];
  }
  return chunk;
}

herr_t set_compression(hid_t list, const Dims& chunk) {
  if (H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data()) < 0 || H5Pset_shuffle(list) < 0) return -1;
  return H5Pset_deflate(list, 4);
}

std::size_t product(const Dims& dims) {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

/// "3 x 4"
std::string shape_text(const Dims& dims) { return fmt::format("{}", fmt::join(dims, " x ")); }

}  // namespace

void File::write_raw(const std::string& path, const Dims& dims, hid_t type, const void* data, std::size_t count) {
  if (product(dims) != count) throw std::logic_error(fmt::format("{}: {} values do not fill its shape", path, count));
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (count > 0 && !plain_) set_compression(list, chunk_of(dims));
  Id set(H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
  if (set.bad() || (count > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) || !set.close())
    fail(path);
}

hid_t File::create_extendible(const std::string& path, hsize_t rows, const Dims& row, hid_t type) {
  // A chunk is packed when it is full: one of 64 appends is seldom packed twice, and a short list is still small.
  Dims dims{0}, limit{H5S_UNLIMITED}, whole{std::clamp<hsize_t>(64 * rows, 1 << 10, 1 << 15)};
  dims.insert(dims.end(), row.begin(), row.end());
  limit.insert(limit.end(), row.begin(), row.end());
  whole.insert(whole.end(), row.begin(), row.end());
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), limit.data()), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  set_compression(list, chunk_of(whole));
  const hid_t set = H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  if (set < 0) fail(path);
  return set;
}

void File::append_raw(const std::string& path, hsize_t rows, const Dims& row, hid_t type, const void* data,
                      std::size_t count) {
  if (rows * product(row) != count)
    throw std::logic_error(fmt::format("{}: {} values do not fill {} rows", path, count, rows));
  auto found = growing_.find(path);
  if (found == growing_.end()) found = growing_.emplace(path, create_extendible(path, rows, row, type)).first;
  if (count == 0) return;
  const hid_t set = found->second;
  Dims start = dims(path), block = start;
  block[0] = rows;
  Dims grown = start;
  grown[0] += rows;
  std::fill(start.begin() + 1, start.end(), 0);
  if (H5Dset_extent(set, grown.data()) < 0) fail(path);
  const Id space(H5Dget_space(set), H5Sclose);
  const Id memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr) < 0 ||
      H5Dwrite(set, type, memory, space, H5P_DEFAULT, data) < 0)
    fail(path);
}

Dims File::dims(const std::string& path) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.bad()) fail(fmt::format("has no dataset {}", path));
  const Id space(H5Dget_space(set), H5Sclose);
  Dims dims(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  if (space.bad() || H5Sget_simple_extent_type(space) == H5S_NULL ||
      H5Sget_simple_extent_dims(space, dims.data(), nullptr) < 0)
    fail(fmt::format("dataset {} has no shape", path));
  return dims;
}

std::size_t File::length(const std::string& path) const {
  const auto found = dims(path);
  if (found.size() != 1) refuse_shape(path, found, "a list is asked for");
  return found[0];
}

void File::refuse_shape(const std::string& path, const Dims& found, const std::string& why) const {
  refuse(fmt::format("dataset {} has shape {}", path, found.empty() ? "of one number" : shape_text(found)), why);
}

std::size_t File::checked_count(const std::string& path, const Dims& expected, hid_t type) const {
  const auto found = dims(path);
  if (found != expected)
    refuse_shape(path, found, fmt::format("the rest of the file asks for {}", shape_text(expected)));
  check_stored(path, found, type);
  return product(expected);
}

std::size_t File::checked_rows(const std::string& path, hsize_t first, hsize_t rows, const Dims& row,
                               hid_t type) const {
  const auto found = dims(path);
  if (found.empty() || Dims(found.begin() + 1, found.end()) != row)
    refuse_shape(path, found,
                 row.empty() ? "a list is asked for" : fmt::format("rows of {} are asked for", shape_text(row)));
  if (rows > found[0] || first > found[0] - rows)
    refuse_shape(path, found, fmt::format("the rest of the file speaks of rows {} to {}", first, first + rows));
  check_stored(path, found, type);
  return rows * product(row);
}

/// A shape is only a claim: deflate packs zeros 1032 times at most, so what takes less room than that is not there.
void File::check_stored(const std::string& path, const Dims& shape, hid_t type) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Id in_file(H5Dget_type(set), H5Tclose);
  if (set.bad() || in_file.bad()) fail(fmt::format("dataset {} cannot be read", path));
  if (!same_class(in_file, type))
    refuse(fmt::format("dataset {} holds values of another kind", path),
           H5Tget_class(type) == H5T_INTEGER ? "whole numbers are asked for" : "real numbers are asked for");
  constexpr double most_packed = 1100;
  double bytes = static_cast<double>(H5Tget_size(in_file));
  for (const hsize_t count : shape) bytes *= static_cast<double>(count);
  const auto stored = static_cast<double>(H5Dget_storage_size(set));
  if (bytes > most_packed * stored)
    refuse(fmt::format("dataset {} has shape {}", path, shape_text(shape)),
           fmt::format("but only {:.0f} bytes in the file", stored));
}

void File::read_raw(const std::string& path, hid_t type, void* data) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.bad() || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    fail(fmt::format("dataset {} cannot be read", path));
}

void File::read_rows_raw(const std::string& path, hsize_t first, hsize_t rows, hid_t type, void* data) const {
  const auto shape = dims(path);
  Dims start(shape.size(), 0), block = shape;
  start[0] = first;
  block[0] = rows;
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Id there(H5Dget_space(set), H5Sclose);
  const Id here(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  const bool chosen = H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr) >= 0;
  if (!chosen || H5Dread(set, type, here, there, H5P_DEFAULT, data) < 0)
    fail(fmt::format("dataset {} cannot be read", path));
}

}  // namespace talus::h5
