// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/hdf5.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/run/hdf5_id.hpp"
#include "common/run/prepare_hdf5.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/write_fault.hpp"

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

}  // namespace

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
      growing_(std::exchange(other.growing_, {})),
      plain_(other.plain_) {}

File::~File() {
  for (const auto& [path, set] : growing_) H5Dclose(set);
  if (id_ >= 0 && H5Fclose(id_) < 0) end_before_libraries();
}

void File::close() {
  while (!growing_.empty()) {
    const auto node = growing_.extract(growing_.begin());
    if (H5Dclose(node.mapped()) < 0) fail(node.key());
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
  H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_attr_creation_order(list, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
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
  // In the order of the file, and sorted here: HDF5 1.10 frees what it never set where it sorts a large group itself
  // and a read fails.
  if (H5Literate_by_name(id_, group.c_str(), H5_INDEX_CRT_ORDER, H5_ITER_NATIVE, nullptr, collect, &links,
                         H5P_DEFAULT) < 0) {
    fail(fmt::format("cannot read group {}", group));
  }
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (Link& link : links) names.push_back(std::move(link.second));
  return names;
}

void File::refuse(const std::string& problem, const std::string& why) const {
  throw DataError({fmt::format("{}: {}", naming_.shown.string(), problem), why, naming_.mend});
}

}  // namespace talus::h5
