// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <functional>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "common/run/hdf5.hpp"
#include "common/run/packing.hpp"

namespace talus::h5 {
namespace {

constexpr hsize_t most_values = 1 << 15;  // of a chunk

/// Chunks of at most 2^15 values: a good size for the cache HDF5 keeps (1 MiB) and for reading one map or one frame. A
/// chunk is one piece of the values in memory: whole in its last dimensions, a part of one, one of each before.
Dims chunk_of(const Dims& dims) {
  Dims chunk = dims;
  hsize_t left = most_values;
  for (auto i = chunk.size(); i-- > 0;) {
    chunk[i] = std::clamp<hsize_t>(chunk[i], 1, std::max<hsize_t>(left, 1));
    left /= chunk[i];
  }
  return chunk;
}

/// Whether `list` names the filters that packed() applies: chunks of a list that lacks one would be read wrongly.
bool set_compression(hid_t list, const Dims& chunk) {
  return H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data()) >= 0 && H5Pset_shuffle(list) >= 0 &&
         H5Pset_deflate(list, effort) >= 0;
}

std::size_t product(std::span<const hsize_t> dims) {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

/// The dimension of which a chunk has a part.
std::size_t cut_of(const Dims& chunk) {
  std::size_t cut = 0;
  while (cut + 1 < chunk.size() && chunk[cut] == 1) ++cut;
  return cut;
}

/// The chunks that hold values of the shape `block`, the first of whose rows is row `first` of the dataset.
class Pieces {
 public:
  /// A chunk's place in the dataset, and the values of it that are asked for: from where on, in bytes, they lie among
  /// the values in memory and in the chunk, and how many bytes they are.
  struct Piece {
    Dims offset;
    std::size_t at, skip, bytes;
  };

  Pieces(hsize_t first, const Dims& block, const Dims& chunk, std::size_t width)
      : first_(first), block_(block), chunk_(chunk), cut_(cut_of(chunk)) {
    row_ = product(std::span(block).subspan(cut_ + 1)) * width;
    start_ = cut_ == 0 ? first : 0;
    const std::size_t parts_before = start_ / chunk[cut_];
    parts_ = (start_ + block[cut_] + chunk[cut_] - 1) / chunk[cut_] - parts_before;
    count_ = product(std::span(block).first(cut_)) * parts_;
    chunk_bytes_ = chunk[cut_] * row_;
  }
  std::size_t count() const { return count_; }
  std::size_t chunk_bytes() const { return chunk_bytes_; }  ///< of the values of a whole one

  Piece operator[](std::size_t c) const {
    const hsize_t chunk = (start_ / chunk_[cut_] + c % parts_) * chunk_[cut_];
    const hsize_t from = std::max(chunk, start_), to = std::min(chunk + chunk_[cut_], start_ + block_[cut_]);
    Piece piece{Dims(block_.size(), 0), (c / parts_ * block_[cut_] + from - start_) * row_, (from - chunk) * row_,
                (to - from) * row_};
    std::size_t left = c / parts_;
    for (std::size_t d = cut_; d-- > 0; left /= block_[d]) piece.offset[d] = left % block_[d];
    if (cut_ > 0) piece.offset[0] += first_;
    piece.offset[cut_] = chunk;
    return piece;
  }

 private:
  hsize_t first_;
  const Dims &block_, &chunk_;
  std::size_t cut_;
  std::size_t row_;    // bytes of the values from one index of that dimension to the next
  hsize_t start_;      // the first index of it
  std::size_t parts_;  // chunks along it
  std::size_t count_, chunk_bytes_;
};

constexpr std::size_t at_a_time = 64;  // chunks in memory

/// Writes values of the shape `block`, the first of whose rows is row `first` of the dataset and of a chunk, and
/// returns whether that worked. Chunks are packed on all threads, and handed to HDF5, which would pack them on one, as
/// they are stored.
bool write_chunks(hid_t set, hsize_t first, const Dims& block, const Dims& chunk, std::size_t width, const char* data) {
  const Pieces pieces(first, block, chunk, width);
  std::vector<std::string> stored(std::min(pieces.count(), at_a_time));
  for (std::size_t begin = 0; begin < pieces.count(); begin += at_a_time) {
    const std::size_t end = std::min(begin + at_a_time, pieces.count());
    tbb::parallel_for(begin, end, [&](std::size_t c) {
      const Pieces::Piece piece = pieces[c];
      stored[c - begin] = packed({data + piece.at, piece.bytes}, pieces.chunk_bytes(), width);
    });
    for (std::size_t c = begin; c < end; ++c) {
      const std::string& bytes = stored[c - begin];
      if (H5Dwrite_chunk(set, H5P_DEFAULT, 0, pieces[c].offset.data(), bytes.size(), bytes.data()) < 0) return false;
    }
  }
  return true;
}

/// The shape of the chunks of a dataset, where they are stored as write_chunks() stores those of a type; else none.
std::optional<Dims> packed_chunks(hid_t set, const Dims& shape, hid_t type) {
  const Id list(H5Dget_create_plist(set), H5Pclose), in_file(H5Dget_type(set), H5Tclose);
  if (list.bad() || in_file.bad() || shape.empty() || H5Tequal(in_file, type) <= 0) return std::nullopt;
  if (H5Pget_layout(list) != H5D_CHUNKED || H5Pget_nfilters(list) != 2) return std::nullopt;
  for (const unsigned k : {0U, 1U}) {
    unsigned flags = 0;
    std::size_t none = 0;
    if (H5Pget_filter2(list, k, &flags, &none, nullptr, 0, nullptr, nullptr) !=
        (k == 0 ? H5Z_FILTER_SHUFFLE : H5Z_FILTER_DEFLATE))
      return std::nullopt;
  }
  Dims chunk(shape.size());
  if (H5Pget_chunk(list, static_cast<int>(chunk.size()), chunk.data()) != static_cast<int>(chunk.size()))
    return std::nullopt;
  const std::size_t whole = cut_of(chunk) + 1;
  const bool as_written = std::ranges::equal(std::span(chunk).subspan(whole), std::span(shape).subspan(whole));
  return as_written && product(chunk) <= most_values ? std::optional(chunk) : std::nullopt;
}

/// Reads values of the shape `block`, the first of whose rows is row `first` of the dataset. Chunks are unpacked on all
/// threads. Returns false where they are stored otherwise, or one is damaged: HDF5 reads it, or says what is wrong.
bool read_chunks(hid_t set, const Dims& shape, hsize_t first, const Dims& block, hid_t type, char* data) {
  const auto chunk = packed_chunks(set, shape, type);
  if (!chunk) return false;
  const std::size_t width = H5Tget_size(type);
  const Pieces pieces(first, block, *chunk, width);
  std::vector<std::string> stored(std::min(pieces.count(), at_a_time));
  for (std::size_t begin = 0; begin < pieces.count(); begin += at_a_time) {
    const std::size_t end = std::min(begin + at_a_time, pieces.count());
    for (std::size_t c = begin; c < end; ++c) {
      const Pieces::Piece piece = pieces[c];
      hsize_t bytes = 0;
      std::uint32_t skipped_filters = 0;
      if (H5Dget_chunk_storage_size(set, piece.offset.data(), &bytes) < 0 || bytes == 0 ||
          bytes > 2 * pieces.chunk_bytes() + 1024)
        return false;
      stored[c - begin].resize(bytes);
      if (H5Dread_chunk(set, H5P_DEFAULT, piece.offset.data(), &skipped_filters, stored[c - begin].data()) < 0 ||
          skipped_filters != 0)
        return false;
    }
    std::atomic<bool> whole = true;
    tbb::parallel_for(begin, end, [&](std::size_t c) {
      const Pieces::Piece piece = pieces[c];
      if (!unpacked(stored[c - begin], pieces.chunk_bytes(), width, piece.skip, {data + piece.at, piece.bytes}))
        whole = false;
    });
    if (!whole) return false;
  }
  return true;
}

/// "3 x 4"
std::string shape_text(const Dims& dims) { return fmt::format("{}", fmt::join(dims, " x ")); }

}  // namespace

void File::write_raw(const std::string& path, const Dims& dims, hid_t type, const void* data, std::size_t count) {
  if (product(dims) != count) throw std::logic_error(fmt::format("{}: {} values do not fill its shape", path, count));
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const bool plain = plain_ || count == 0 || dims.empty();
  if (!plain && !set_compression(list, chunk_of(dims))) fail(path);
  Id set(H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
  const auto written = [&] {
    if (count == 0) return true;
    if (plain) return H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    return write_chunks(set, 0, dims, chunk_of(dims), H5Tget_size(type), static_cast<const char*>(data));
  };
  if (set.bad() || !written() || !set.close()) fail(path);
}

File::Growing File::create_extendible(const std::string& path, hsize_t rows, const Dims& row, hid_t type) {
  // A short list stays small.
  Dims dims{0}, limit{H5S_UNLIMITED}, whole{std::clamp<hsize_t>(64 * rows, 1 << 10, 1 << 15)};
  dims.insert(dims.end(), row.begin(), row.end());
  limit.insert(limit.end(), row.begin(), row.end());
  whole.insert(whole.end(), row.begin(), row.end());
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), limit.data()), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!set_compression(list, chunk_of(whole))) fail(path);
  const hid_t set = H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  if (set < 0) fail(path);
  return {.set = set, .shape = dims, .chunk = chunk_of(whole), .width = H5Tget_size(type)};
}

void File::append_raw(const std::string& path, hsize_t rows, const Dims& row, hid_t type, const void* data,
                      std::size_t count) {
  if (rows * product(row) != count)
    throw std::logic_error(fmt::format("{}: {} values do not fill {} rows", path, count, rows));
  auto found = growing_.find(path);
  if (found == growing_.end()) found = growing_.emplace(path, create_extendible(path, rows, row, type)).first;
  Growing& growing = found->second;
  growing.waiting.append(static_cast<const char*>(data), count * growing.width);
  growing.rows_waiting += rows;
  store(path, growing, growing.rows_waiting / growing.chunk[0] * growing.chunk[0]);
}

/// The method has the first of the rows that wait packed, and writes what is packed.
void File::store(const std::string& path, Growing& growing, hsize_t rows) {
  if (rows == 0) return;
  Dims block = growing.shape;
  block[0] = rows;
  const hsize_t first = std::exchange(growing.shape[0], growing.shape[0] + rows);
  if (H5Dset_extent(growing.set, growing.shape.data()) < 0) fail(path);
  const Pieces pieces(first, block, growing.chunk, growing.width);
  if (!packing_) packing_ = std::make_unique<PackingQueue>();
  for (std::size_t c = 0; c < pieces.count(); ++c) {
    Pieces::Piece piece = pieces[c];
    packing_->add({.path = path,
                   .set = growing.set,
                   .offset = std::move(piece.offset),
                   .values = growing.waiting.substr(piece.at, piece.bytes),
                   .bytes = pieces.chunk_bytes(),
                   .width = growing.width});
  }
  growing.waiting.erase(0, product(block) * growing.width);
  growing.rows_waiting -= rows;
  write_packed(false);
}

void File::write_packed(bool all) {
  if (!packing_) return;
  packing_->write(all, [&](const PackingChunk& chunk) {
    if (H5Dwrite_chunk(chunk.set, H5P_DEFAULT, 0, chunk.offset.data(), chunk.stored.size(), chunk.stored.data()) < 0)
      fail(chunk.path);
  });
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
  const auto shape = dims(path);
  if (!shape.empty()) return read_rows_raw(path, 0, shape[0], type, data);
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
  if (!set.bad() && read_chunks(set, shape, first, block, type, static_cast<char*>(data))) return;
  const Id there(H5Dget_space(set), H5Sclose);
  const Id here(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  const bool chosen = H5Sselect_hyperslab(there, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr) >= 0;
  if (!chosen || H5Dread(set, type, here, there, H5P_DEFAULT, data) < 0)
    fail(fmt::format("dataset {} cannot be read", path));
}

}  // namespace talus::h5
