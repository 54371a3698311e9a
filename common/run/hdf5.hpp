// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A thin layer over the HDF5 C API: every call is checked, every failure is a DataError that names the file and the
// system's reason. Objects are named by their path in the file ("/maps/terrain"), so no handle leaves this header.
// Groups are written and read in hdf5.cpp, attributes and datasets in files of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hdf5.h>

namespace talus::h5 {

using Dims = std::vector<hsize_t>;

/// The type of HDF5 that a type of C++ is in memory.
template <class T>
hid_t native_type();
/// The type of HDF5 that a type of C++ is in memory.
template <>
inline hid_t native_type<double>() {
  return H5T_NATIVE_DOUBLE;
}
/// The type of HDF5 that a type of C++ is in memory.
template <>
inline hid_t native_type<float>() {
  return H5T_NATIVE_FLOAT;
}
/// The type of HDF5 that a type of C++ is in memory.
template <>
inline hid_t native_type<std::int32_t>() {
  return H5T_NATIVE_INT32;
}
/// The type of HDF5 that a type of C++ is in memory.
template <>
inline hid_t native_type<std::int64_t>() {
  return H5T_NATIVE_INT64;
}
/// The type of HDF5 that a type of C++ is in memory.
template <>
inline hid_t native_type<std::uint8_t>() {
  return H5T_NATIVE_UINT8;
}

/// What messages say of a file: its name as the user knows it, and how to mend it where it cannot be read.
struct Naming {
  std::filesystem::path shown;
  std::string mend;
};

/// An open HDF5 file. Not thread-safe, as HDF5 is not.
class File {
 public:
  /// Create (truncate) `path`.
  static File create(const std::filesystem::path& path, Naming naming);
  /// Open for reading. Missing, truncated or not HDF5: DataError.
  static File open(const std::filesystem::path& path, Naming naming);
  File(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();  ///< closes without looking at errors: call close() where they matter

  /// Flush and close. Throws DataError when bytes could not be written (disk full).
  void close();

  /// Makes a group; those above it must be there.
  void make_group(const std::string& path);
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
  /// Add `rows` rows of shape `row` (empty: scalars) to an extendible dataset, made on the first call.
  template <class T>
  void append(const std::string& path, hsize_t rows, const Dims& row, std::span<const T> values) {
    append_raw(path, rows, row, native_type<T>(), values.data(), values.size());
  }
  /// The shape of a dataset.
  Dims dims(const std::string& path) const;
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

  /// Throws the DataError of this file: "FILE: `problem` (reason HDF5 gives). mend", or where it is being written, what
  /// write_fault() says of it.
  [[noreturn]] void fail(const std::string& problem) const;
  /// Throws "FILE: `problem` (why). mend" of something that was read but cannot be right.
  [[noreturn]] void refuse(const std::string& problem, const std::string& why) const;

 private:
  File(hid_t id, Naming naming, bool writing) : id_(id), naming_(std::move(naming)), writing_(writing) {}
  void write_raw(const std::string& path, const Dims& dims, hid_t type, const void* data, std::size_t count);
  void append_raw(const std::string& path, hsize_t rows, const Dims& row, hid_t type, const void* data,
                  std::size_t count);
  hid_t create_extendible(const std::string& path, hsize_t rows, const Dims& row, hid_t type);
  std::size_t checked_count(const std::string& path, const Dims& expected, hid_t type) const;
  std::size_t checked_rows(const std::string& path, hsize_t first, hsize_t rows, const Dims& row, hid_t type) const;
  [[noreturn]] void refuse_shape(const std::string& path, const Dims& found, const std::string& why) const;
  void check_stored(const std::string& path, const Dims& shape, hid_t type) const;
  void read_raw(const std::string& path, hid_t type, void* data) const;
  void read_rows_raw(const std::string& path, hsize_t first, hsize_t rows, hid_t type, void* data) const;

  hid_t id_;
  Naming naming_;
  bool writing_;
  std::map<std::string, hid_t> growing_;  ///< datasets of append(), open so that HDF5 keeps their last, partial chunks
  bool plain_ = false;
};

}  // namespace talus::h5
