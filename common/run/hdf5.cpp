// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/hdf5.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/write_fault.hpp"

namespace talus::h5 {
namespace {

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

/// The innermost reason on HDF5's error stack; the system's own words where it has them.
std::string reason() {
  std::vector<std::string> lines;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        if (error->desc != nullptr && *error->desc != '\0')
          static_cast<std::vector<std::string>*>(data)->emplace_back(error->desc);
        return 0;
      },
      &lines);
  static constexpr std::string_view mark = "error message = '";
  for (const auto& line : lines) {
    const auto start = line.find(mark);
    if (start == std::string::npos) continue;
    return line.substr(start + mark.size(), line.find('\'', start + mark.size()) - start - mark.size());
  }
  return lines.empty() ? std::string() : lines.front();
}

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

/// Before the first call of HDF5. Its own error printing goes: ours says it once. Its clean-up at exit goes too: a file
/// that a full disk kept from closing makes it write again and crash, and every file here is closed by its owner
/// anyway.
void prepare_library() {
  static const bool once = [] {
    // Its own locks fail where a file system has none, and guard nothing here: files are read under their final names,
    // when they are whole, and the output folder has a lock (common/stage/output_lock.hpp).
    ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
    H5dont_atexit();
    return true;
  }();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// After a file that HDF5 could not close. H5dont_atexit() does not hold back the C++ library of HDF5, which GDAL
/// brings: where it is unloaded it ends HDF5, which crashes over that file. So the process ends before libraries are
/// unloaded, with the exit code it has.
void end_before_libraries() {
  static const int once = ::on_exit(
      [](int code, void*) {
        std::fflush(nullptr);
        ::_exit(code);
      },
      nullptr);
  static_cast<void>(once);
}

std::size_t product(const Dims& dims) {
  return std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
}

/// "3 x 4"
std::string shape_text(const Dims& dims) { return fmt::format("{}", fmt::join(dims, " x ")); }

}  // namespace

File File::create(const std::filesystem::path& path, Naming naming) {
  prepare_library();
  const Id root(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_link_creation_order(root, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  File file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, root, H5P_DEFAULT), std::move(naming), true);
  if (file.id_ < 0) file.fail("it cannot be created");
  return file;
}

File File::open(const std::filesystem::path& path, Naming naming) {
  prepare_library();
  if (!std::filesystem::exists(path)) throw DataError({naming.shown.string() + ": no such file", "", naming.mend});
  require_plain(path);
  File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), std::move(naming), false);
  if (file.id_ < 0) file.fail("cannot be opened as HDF5");
  return file;
}

File::File(File&& other) noexcept
    : id_(std::exchange(other.id_, hid_t{-1})),
      naming_(std::move(other.naming_)),
      writing_(other.writing_),
      plain_(other.plain_) {}

File::~File() {
  if (id_ >= 0 && H5Fclose(id_) < 0) end_before_libraries();
}

void File::close() {
  if (H5Fflush(id_, H5F_SCOPE_LOCAL) < 0) fail("the end of the file");
  if (H5Fclose(std::exchange(id_, hid_t{-1})) >= 0) return;
  end_before_libraries();
  fail("closing it");
}

void File::fail(const std::string& problem) const {
  const auto why = reason();
  if (writing_) throw DataError(write_fault(naming_.shown, why.empty() ? problem : problem + ": " + why));
  throw DataError({fmt::format("{}: {}", naming_.shown.string(), problem), why, naming_.mend});
}

void File::make_group(const std::string& path) {
  const Id list(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  Id group(H5Gcreate2(id_, path.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose);
  if (group.bad() || !group.close()) fail(fmt::format("group {}", path));
}

bool File::exists(const std::string& path) const {
  for (auto end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1)) {
    if (H5Lexists(id_, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(id_, path.c_str(), H5P_DEFAULT) > 0;
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

bool File::is_group(const std::string& path) const {
  const Id object(H5Oopen(id_, path.c_str(), H5P_DEFAULT), H5Oclose);
  if (object.bad()) fail(fmt::format("{} cannot be opened", path));
  return H5Iget_type(object) == H5I_GROUP;
}

H5T_class_t File::class_of(const std::string& path) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.bad()) fail(fmt::format("has no dataset {}", path));
  const Id type(H5Dget_type(set), H5Tclose);
  return H5Tget_class(type);
}

std::vector<std::string> File::children(const std::string& group) const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Literate_by_name(id_, group.c_str(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names, H5P_DEFAULT) <
      0) {
    fail(fmt::format("cannot read group {}", group));
  }
  return names;
}

std::vector<std::string> File::attribute_names(const std::string& object) const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Aiterate_by_name(id_, object.c_str(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, collect, &names, H5P_DEFAULT) <
      0) {
    fail(fmt::format("cannot read the attributes of {}", object));
  }
  return names;
}

namespace {

/// The value of an attribute: its types in the file and in memory, and its size.
struct AttributeValue {
  hid_t file_type, memory_type, space;
  const void* data;
};

/// Write one attribute; false when HDF5 refuses.
bool write_attribute(hid_t file, const std::string& object, const std::string& name, const AttributeValue& value) {
  Id attribute(H5Acreate_by_name(file, object.c_str(), name.c_str(), value.file_type, value.space, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
               H5Aclose);
  return !attribute.bad() && H5Awrite(attribute, value.memory_type, value.data) >= 0 && attribute.close();
}

}  // namespace

void File::set_text(const std::string& object, const std::string& name, const std::string& value) {
  // Fixed length, as VTK asks of its Type attribute; UTF-8 only where the text is not plain ASCII.
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  if (std::any_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) > 127; })) {
    H5Tset_cset(type, H5T_CSET_UTF8);
  }
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const char* data = value.empty() ? "\0" : value.data();
  if (!write_attribute(id_, object, name, {type, type, space, data}))
    fail(fmt::format("attribute {} {}", object, name));
}

void File::set_number(const std::string& object, const std::string& name, double value) {
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!write_attribute(id_, object, name, {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, &value})) {
    fail(fmt::format("attribute {} {}", object, name));
  }
}

void File::set_integers(const std::string& object, const std::string& name, std::span<const std::int64_t> values) {
  const hsize_t count = values.size();
  const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  if (!write_attribute(id_, object, name, {H5T_STD_I64LE, H5T_NATIVE_INT64, space, values.data()})) {
    fail(fmt::format("attribute {} {}", object, name));
  }
}

namespace {

constexpr std::size_t longest_text = std::size_t{1} << 24;  // bytes; the longest that is written is a CRS

/// Whether a type of a file is one number of the class (whole, real) of a type in memory.
bool same_class(hid_t in_file, hid_t in_memory) { return H5Tget_class(in_file) == H5Tget_class(in_memory); }

/// Whether an attribute holds one value.
bool is_single(hid_t attribute) {
  const Id space(H5Aget_space(attribute), H5Sclose);
  return !space.bad() && H5Sget_simple_extent_npoints(space) == 1;
}

}  // namespace

std::string File::text(const std::string& object, const std::string& name) const {
  const auto problem = fmt::format("attribute {} {} cannot be read", object, name);
  const Id attribute(H5Aopen_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.bad()) fail(problem);
  const Id type(H5Aget_type(attribute), H5Tclose);
  if (type.bad() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || !is_single(attribute))
    refuse(problem, "it is not one text");
  const std::size_t size = H5Tget_size(type);
  if (size > longest_text || size > H5Aget_storage_size(attribute))
    refuse(problem, fmt::format("it claims to have {} bytes", size));
  std::string value(size, '\0');
  if (H5Aread(attribute, type, value.data()) < 0) fail(problem);
  value.resize(std::min(value.find('\0'), value.size()));
  return value;
}

namespace {

bool read_scalar(hid_t file, const std::string& object, const std::string& name, hid_t type, void* value) {
  const Id attribute(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.bad() || !is_single(attribute)) return false;
  const Id in_file(H5Aget_type(attribute), H5Tclose);
  return !in_file.bad() && same_class(in_file, type) && H5Aread(attribute, type, value) >= 0;
}

}  // namespace

double File::number(const std::string& object, const std::string& name) const {
  double value = 0;
  if (!read_scalar(id_, object, name, H5T_NATIVE_DOUBLE, &value))
    fail(fmt::format("attribute {} {} cannot be read", object, name));
  return value;
}

std::int64_t File::integer(const std::string& object, const std::string& name) const {
  std::int64_t value = 0;
  if (!read_scalar(id_, object, name, H5T_NATIVE_INT64, &value))
    fail(fmt::format("attribute {} {} cannot be read", object, name));
  return value;
}

void File::write_raw(const std::string& path, const Dims& dims, hid_t type, const void* data, std::size_t count) {
  if (product(dims) != count) throw std::logic_error(fmt::format("{}: {} values do not fill its shape", path, count));
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (count > 0 && !plain_) set_compression(list, chunk_of(dims));
  Id set(H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
  if (set.bad() || (count > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) || !set.close()) {
    fail(path);
  }
}

void File::create_extendible(const std::string& path, const Dims& row, hid_t type) {
  Dims dims{0}, limit{H5S_UNLIMITED}, whole{hsize_t{1} << 15};
  dims.insert(dims.end(), row.begin(), row.end());
  limit.insert(limit.end(), row.begin(), row.end());
  whole.insert(whole.end(), row.begin(), row.end());
  const Id space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), limit.data()), H5Sclose);
  const Id list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  set_compression(list, chunk_of(whole));
  Id set(H5Dcreate2(id_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
  if (set.bad() || !set.close()) fail(path);
}

void File::append_raw(const std::string& path, hsize_t rows, const Dims& row, hid_t type, const void* data,
                      std::size_t count) {
  if (rows * product(row) != count)
    throw std::logic_error(fmt::format("{}: {} values do not fill {} rows", path, count, rows));
  if (!exists(path)) create_extendible(path, row, type);
  if (count == 0) return;
  Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  Dims start = dims(path), block = start;
  block[0] = rows;
  Dims grown = start;
  grown[0] += rows;
  std::fill(start.begin() + 1, start.end(), 0);
  if (set.bad() || H5Dset_extent(set, grown.data()) < 0) fail(path);
  const Id space(H5Dget_space(set), H5Sclose);
  const Id memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr) < 0 ||
      H5Dwrite(set, type, memory, space, H5P_DEFAULT, data) < 0 || !set.close()) {
    fail(path);
  }
}

Dims File::dims(const std::string& path) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.bad()) fail(fmt::format("has no dataset {}", path));
  const Id space(H5Dget_space(set), H5Sclose);
  Dims dims(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  if (space.bad() || H5Sget_simple_extent_type(space) == H5S_NULL ||
      H5Sget_simple_extent_dims(space, dims.data(), nullptr) < 0) {
    fail(fmt::format("dataset {} has no shape", path));
  }
  return dims;
}

std::size_t File::length(const std::string& path) const {
  const auto found = dims(path);
  if (found.size() != 1) refuse_shape(path, found, "a list is asked for");
  return found[0];
}

void File::refuse(const std::string& problem, const std::string& why) const {
  throw DataError({fmt::format("{}: {}", naming_.shown.string(), problem), why, naming_.mend});
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
  if (found.empty() || Dims(found.begin() + 1, found.end()) != row) {
    refuse_shape(path, found,
                 row.empty() ? "a list is asked for" : fmt::format("rows of {} are asked for", shape_text(row)));
  }
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
  if (!same_class(in_file, type)) {
    refuse(fmt::format("dataset {} holds values of another kind", path),
           H5Tget_class(type) == H5T_INTEGER ? "whole numbers are asked for" : "real numbers are asked for");
  }
  constexpr double most_packed = 1100;
  double bytes = static_cast<double>(H5Tget_size(in_file));
  for (const hsize_t count : shape) bytes *= static_cast<double>(count);
  const auto stored = static_cast<double>(H5Dget_storage_size(set));
  if (bytes > most_packed * stored) {
    refuse(fmt::format("dataset {} has shape {}", path, shape_text(shape)),
           fmt::format("but only {:.0f} bytes in the file", stored));
  }
}

void File::read_raw(const std::string& path, hid_t type, void* data) const {
  const Id set(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.bad() || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    fail(fmt::format("dataset {} cannot be read", path));
  }
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
  if (!chosen || H5Dread(set, type, here, there, H5P_DEFAULT, data) < 0) {
    fail(fmt::format("dataset {} cannot be read", path));
  }
}

}  // namespace talus::h5
