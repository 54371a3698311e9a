// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/hdf5.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include "common/error.hpp"
#include "common/run/packing.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/files.hpp"

namespace talus::h5 {
namespace {

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

constexpr std::size_t longest_text = std::size_t{1} << 24;  // bytes; the longest that is written is a CRS

bool is_single(hid_t attribute) {
  const Id space(H5Aget_space(attribute), H5Sclose);
  return !space.bad() && H5Sget_simple_extent_npoints(space) == 1;
}

bool read_scalar(hid_t file, const std::string& object, const std::string& name, hid_t type, void* value) {
  const Id attribute(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (attribute.bad() || !is_single(attribute)) return false;
  const Id in_file(H5Aget_type(attribute), H5Tclose);
  return !in_file.bad() && same_class(in_file, type) && H5Aread(attribute, type, value) >= 0;
}

}  // namespace

/// Before the first call of HDF5. Its own error printing goes: ours says it once. Its clean-up at exit goes too: it
/// would write again and crash over a file that a full disk kept from closing; every file here is closed by its owner.
void prepare_library() {
  static const bool once = [] {
    // Its own locks fail where a file system has none, and guard nothing here: files are read under their final names,
    // when they are whole, and the output folder has a lock (common/stage/files.hpp).
    ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
    H5dont_atexit();
    return true;
  }();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

File File::create(const std::filesystem::path& path, Naming naming) {
  prepare_library();
  const Id root(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  const bool ordered = H5Pset_link_creation_order(root, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0;
  File file(ordered ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, root, H5P_DEFAULT) : hid_t{-1}, std::move(naming), true);
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

File::File(hid_t id, Naming naming, bool writing) : id_(id), naming_(std::move(naming)), writing_(writing) {}

File::File(File&& other) noexcept
    : id_(std::exchange(other.id_, hid_t{-1})),
      naming_(std::move(other.naming_)),
      writing_(other.writing_),
      growing_(std::exchange(other.growing_, {})),
      packing_(std::move(other.packing_)),
      plain_(other.plain_) {}

File::~File() {
  for (const auto& [path, growing] : growing_) H5Dclose(growing.set);
  if (id_ >= 0 && H5Fclose(id_) < 0) end_before_libraries();
}

void File::close() {
  for (auto& [path, growing] : growing_) store(path, growing, growing.rows_waiting);
  write_packed(true);
  while (!growing_.empty()) {
    const auto node = growing_.extract(growing_.begin());
    if (H5Dclose(node.mapped().set) < 0) fail(node.key());
  }
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
  if (H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) < 0 ||
      H5Pset_attr_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) < 0)
    fail(fmt::format("group {}", path));
  Id group(H5Gcreate2(id_, path.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose);
  if (group.bad() || !group.close()) fail(fmt::format("group {}", path));
}

bool File::exists(const std::string& path) const {
  const auto is_there = [&](const std::string& link) {
    const htri_t found = H5Lexists(id_, link.c_str(), H5P_DEFAULT);
    if (found < 0) fail(fmt::format("cannot look for {}", link));
    return found > 0;
  };
  for (auto end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1))
    if (!is_there(path.substr(0, end))) return false;
  return is_there(path);
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
  const htri_t found = H5Aexists_by_name(id_, object.c_str(), name.c_str(), H5P_DEFAULT);
  if (found < 0) fail(fmt::format("cannot look for attribute {} of {}", name, object));
  return found > 0;
}

std::vector<std::string> File::children(const std::string& group) const {
  using Link = std::pair<std::int64_t, std::string>;
  std::vector<Link> links;
  const auto collect = [](hid_t, const char* name, const H5L_info_t* link, void* data) -> herr_t {
    static_cast<std::vector<Link>*>(data)->emplace_back(link->corder, name);
    return 0;
  };
  // In the order of the file, and sorted here: HDF5 1.10 frees what it never set where it sorts and a read fails.
  if (H5Literate_by_name(id_, group.c_str(), H5_INDEX_CRT_ORDER, H5_ITER_NATIVE, nullptr, collect, &links,
                         H5P_DEFAULT) < 0)
    fail(fmt::format("cannot read group {}", group));
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (Link& link : links) names.push_back(std::move(link.second));
  return names;
}

void File::refuse(const std::string& problem, const std::string& why) const {
  throw DataError({fmt::format("{}: {}", naming_.shown.string(), problem), why, naming_.mend});
}

void File::set_attribute(const std::string& object, const std::string& name, hid_t space, hid_t in_file,
                         hid_t in_memory, const void* data) {
  Id attribute(
      H5Acreate_by_name(id_, object.c_str(), name.c_str(), in_file, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (attribute.bad() || H5Awrite(attribute, in_memory, data) < 0 || !attribute.close())
    fail(fmt::format("attribute {} {}", object, name));
}

void File::set_text(const std::string& object, const std::string& name, const std::string& value) {
  // Fixed length, as VTK asks of its Type attribute; UTF-8 only where the text is not plain ASCII.
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  if (std::any_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) > 127; }))
    H5Tset_cset(type, H5T_CSET_UTF8);
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  set_attribute(object, name, space, type, type, value.empty() ? "\0" : value.data());
}

void File::set_number(const std::string& object, const std::string& name, double value) {
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  set_attribute(object, name, space, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void File::set_integers(const std::string& object, const std::string& name, std::span<const std::int64_t> values) {
  const hsize_t count = values.size();
  const Id space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  set_attribute(object, name, space, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data());
}

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

}  // namespace talus::h5
