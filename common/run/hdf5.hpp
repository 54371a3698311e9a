// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A thin layer over the HDF5 C API: every call is checked, every failure is a DataError that names the file and the
// system's reason. Objects are named by their path in the file ("/maps/terrain"), so no handle leaves this header.
// Groups and attributes are written and read in hdf5.cpp, datasets in hdf5_datasets.cpp.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <hdf5.h>

#include "common/map/limits.hpp"

namespace talus::h5 {

using Dims = std::vector<hsize_t>;

/// The type of HDF5 that a type of C++ is in memory.
template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

/// What messages say of a file: its name as the user knows it, and how to mend it where it cannot be read.
struct Naming {
  std::filesystem::path shown;
  std::string mend;
};

/// The numbers that may stand in a dataset or an attribute.
struct Allowed {
  double low = -limits::number, high = limits::number;
  bool none = false;  ///< NaN says that there is no value

  bool holds(double value) const { return (value >= low && value <= high) || (none && std::isnan(value)); }
  /// In words, for a refusal.
  std::string words() const {
    return fmt::format("{:g} to {:g} is possible{}", low, high, none ? ", or NaN for none" : "");
  }
};

/// Any number that a quantity can have.
inline constexpr Allowed finite{};
/// The same, or none.
inline constexpr Allowed finite_or_none{.none = true};
/// 0 or more.
inline constexpr Allowed not_negative{.low = 0};
/// 0 or more, or none.
inline constexpr Allowed not_negative_or_none{.low = 0, .none = true};
/// Elevations, or none where there is no ground.
inline constexpr Allowed elevation_or_none{.low = -limits::height, .high = limits::height, .none = true};
/// Vertical thickness [m].
inline constexpr Allowed thickness{.low = 0, .high = limits::height};
/// The same, or none.
inline constexpr Allowed thickness_or_none{.low = 0, .high = limits::height, .none = true};
/// Volumes [m3].
inline constexpr Allowed a_volume{.low = 0, .high = limits::volume};
/// Times from the start of a run [s].
inline constexpr Allowed a_time{.low = 0, .high = limits::time};

class File;
class PackingQueue;
/// Refuses the file where a value of dataset `path` is not allowed.
template <class T>
void check_values(const File& file, const std::string& path, std::span<const T> values, const Allowed& allowed);

/// An open HDF5 file. Not thread-safe, as HDF5 is not.
class File {
 public:
  static File create(const std::filesystem::path& path, Naming naming);  ///< create (truncate) `path`
  /// Open for reading. Missing, truncated or not HDF5: DataError.
  static File open(const std::filesystem::path& path, Naming naming);
  File(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();  ///< closes without looking at errors: call close() where they matter

  /// Flush and close. Throws DataError when bytes could not be written (disk full).
  void close();

  void make_group(const std::string& path);  ///< makes a group; those above it must be there
  /// True when a group or dataset of that path is there. Throws DataError where the file does not let itself be read:
  /// what may be missing is not taken for missing then.
  bool exists(const std::string& path) const;
  /// True when a group or dataset, which must be there, has an attribute of that name. Throws DataError likewise.
  bool has_attribute(const std::string& object, const std::string& name) const;
  std::vector<std::string> children(const std::string& group) const;  ///< in order of creation

  /// Sets an attribute to a text.
  void set_text(const std::string& object, const std::string& name, const std::string& value);
  /// Sets an attribute to a number.
  void set_number(const std::string& object, const std::string& name, double value);
  /// Sets an attribute to a list of whole numbers.
  void set_integers(const std::string& object, const std::string& name, std::span<const std::int64_t> values);
  /// Sets an attribute to a whole number.
  void set_integer(const std::string& object, const std::string& name, std::int64_t value) {
    set_integers(object, name, std::span(&value, 1));
  }
  /// Reads an attribute that is text. Throws DataError where it is none.
  std::string text(const std::string& object, const std::string& name) const;
  /// Reads an attribute that is a number. Throws DataError where it is none.
  double number(const std::string& object, const std::string& name) const;
  /// Reads an attribute that is a whole number. Throws DataError where it is none.
  std::int64_t integer(const std::string& object, const std::string& name) const;

  /// Whole datasets are written as they are from now on: for files that are soon read back and dropped.
  void leave_plain() { plain_ = true; }
  /// Write a whole dataset, compressed where that pays.
  template <class T>
  void write(const std::string& path, const Dims& dims, std::span<const T> values) {
    write_raw(path, dims, native_type<T>(), values.data(), values.size());
  }
  /// Write a list, likewise.
  template <class T>
  void write_list(const std::string& path, std::span<const T> values) {
    write<T>(path, {values.size()}, values);
  }
  /// Add `rows` rows of shape `row` (empty: scalars) to an extendible dataset, made on the first call.
  template <class T>
  void append(const std::string& path, hsize_t rows, const Dims& row, std::span<const T> values) {
    append_raw(path, rows, row, native_type<T>(), values.data(), values.size());
  }
  Dims dims(const std::string& path) const;  ///< the shape of a dataset
  /// The length of a list: of a dataset that must have one dimension.
  std::size_t length(const std::string& path) const;
  /// Read a whole dataset whose shape must be `expected`. Like the readings below it throws DataError where the dataset
  /// holds numbers of another kind, or far fewer bytes than its shape asks for.
  template <class T>
  std::vector<T> read(const std::string& path, const Dims& expected) const {
    std::vector<T> values(checked_count(path, expected, native_type<T>()));
    if (!values.empty()) read_raw(path, native_type<T>(), values.data());
    return values;
  }

  /// Read a list of any length.
  template <class T>
  std::vector<T> read_list(const std::string& path) const {
    return read<T>(path, {length(path)});
  }
  /// Read rows [first, first + rows) of a dataset whose rows must have the shape `row` (empty: single numbers), flat.
  template <class T>
  std::vector<T> read_rows(const std::string& path, hsize_t first, hsize_t rows, const Dims& row) const {
    std::vector<T> values(checked_rows(path, first, rows, row, native_type<T>()));
    if (!values.empty()) read_rows_raw(path, first, rows, native_type<T>(), values.data());
    return values;
  }
  /// The same readings; refuse values that are not allowed.
  template <class T>
  std::vector<T> read(const std::string& path, const Dims& expected, const Allowed& allowed) const {
    return checked(path, read<T>(path, expected), allowed);
  }
  template <class T>
  std::vector<T> read_list(const std::string& path, const Allowed& allowed) const {
    return checked(path, read_list<T>(path), allowed);
  }
  template <class T>
  std::vector<T> read_rows(const std::string& path, hsize_t first, hsize_t rows, const Dims& row,
                           const Allowed& allowed) const {
    return checked(path, read_rows<T>(path, first, rows, row), allowed);
  }

  /// Throws the DataError of this file: "FILE: `problem` (reason HDF5 gives). mend", or where it is being written, what
  /// write_fault() says of it.
  [[noreturn]] void fail(const std::string& problem) const;
  /// Throws "FILE: `problem` (why). mend" of something that was read but cannot be right.
  [[noreturn]] void refuse(const std::string& problem, const std::string& why) const;

 private:
  template <class T>
  std::vector<T> checked(const std::string& path, std::vector<T> values, const Allowed& allowed) const {
    check_values<T>(*this, path, values, allowed);
    return values;
  }
  File(hid_t id, Naming naming, bool writing);
  void set_attribute(const std::string& object, const std::string& name, hid_t space, hid_t in_file, hid_t in_memory,
                     const void* data);
  void write_raw(const std::string& path, const Dims& dims, hid_t type, const void* data, std::size_t count);
  void append_raw(const std::string& path, hsize_t rows, const Dims& row, hid_t type, const void* data,
                  std::size_t count);
  /// A dataset of append(): rows wait until they fill a chunk.
  struct Growing {
    hid_t set;
    Dims shape, chunk;  // of what is in the file
    std::size_t width;  // bytes of a value
    std::string waiting = {};
    hsize_t rows_waiting = 0;
  };
  Growing create_extendible(const std::string& path, hsize_t rows, const Dims& row, hid_t type);
  void store(const std::string& path, Growing& growing, hsize_t rows);
  void write_packed(bool all);  // chunks that have been packed, or all once they are
  std::size_t checked_count(const std::string& path, const Dims& expected, hid_t type) const;
  std::size_t checked_rows(const std::string& path, hsize_t first, hsize_t rows, const Dims& row, hid_t type) const;
  [[noreturn]] void refuse_shape(const std::string& path, const Dims& found, const std::string& why) const;
  void check_stored(const std::string& path, const Dims& shape, hid_t type) const;
  void read_raw(const std::string& path, hid_t type, void* data) const;
  void read_rows_raw(const std::string& path, hsize_t first, hsize_t rows, hid_t type, void* data) const;

  hid_t id_;
  Naming naming_;
  bool writing_;
  std::map<std::string, Growing> growing_;
  std::unique_ptr<PackingQueue> packing_;  // of growing_
  bool plain_ = false;
};

template <class T>
void check_values(const File& file, const std::string& path, std::span<const T> values, const Allowed& allowed) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto value = static_cast<double>(values[n]);
    if (!allowed.holds(value))
      file.refuse(fmt::format("dataset {} holds {:g} at place {}", path, value, n), allowed.words());
  }
}

/// Refuses the file where an attribute is not allowed.
inline double checked_number(const File& file, const std::string& object, const std::string& name,
                             const Allowed& allowed) {
  const double value = file.number(object, name);
  if (!allowed.holds(value)) file.refuse(fmt::format("attribute {} {} is {:g}", object, name, value), allowed.words());
  return value;
}

/// Refuses the file where a list does not grow from value to value, or holds one that is not allowed.
inline void check_growing(const File& file, const std::string& path, std::span<const double> values,
                          const Allowed& allowed) {
  check_values(file, path, values, allowed);
  for (std::size_t n = 1; n < values.size(); ++n)
    if (!(values[n] > values[n - 1]))
      file.refuse(fmt::format("dataset {} holds {:g} behind {:g}", path, values[n], values[n - 1]),
                  "its values must grow");
}

/// Closes an HDF5 identifier of any kind.
class Id {
 public:
  Id(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool bad() const { return id_ < 0; }
  /// Close now and say whether it worked: closing may be what writes.
  bool close() { return close_(std::exchange(id_, hid_t{-1})) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Whether a type of a file is one number of the class (whole, real) of a type in memory.
inline bool same_class(hid_t in_file, hid_t in_memory) { return H5Tget_class(in_file) == H5Tget_class(in_memory); }

}  // namespace talus::h5
