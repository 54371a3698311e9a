// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/trusted_file.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/child_reading.hpp"

namespace talus::h5 {
namespace {

constexpr hsize_t bytes_at_once = 1 << 26;

/// Reads every value of a dataset of numbers, some rows at a time, and forgets them.
void read_through(const File& file, const std::string& path) {
  const Dims shape = file.dims(path);
  const bool whole = file.is_whole(path);
  if (shape.empty() || (!whole && !file.is_real(path))) return;
  const Dims row(shape.begin() + 1, shape.end());
  const hsize_t row_bytes = 8 * std::accumulate(row.begin(), row.end(), hsize_t{1}, std::multiplies<>());
  const hsize_t rows_at_once = std::max<hsize_t>(1, bytes_at_once / std::max<hsize_t>(1, row_bytes));
  for (hsize_t first = 0; first < shape[0]; first += rows_at_once) {
    const hsize_t rows = std::min(rows_at_once, shape[0] - first);
    if (whole) {
      file.read_rows<std::int64_t>(path, first, rows, row);
    } else {
      file.read_rows<double>(path, first, rows, row);
    }
  }
}

/// Reads the attributes of an object and forgets them; whether they are what they must be is for the reader to say.
void read_attributes(const File& file, const std::string& object) {
  for (const std::string& name : file.attribute_names(object)) {
    try {
      file.text(object, name);
    } catch (const DataError&) {
      try {
        file.number(object, name);
      } catch (const DataError&) {
        continue;
      }
    }
  }
}

/// Reads a group and all below it; deeper than files of this program are is a loop.
void read_group(const File& file, const std::string& group, int depth) {
  if (depth > 8) file.refuse("groups stand in one another without end", group);
  for (const std::string& name : file.children(group)) {
    const std::string path = (group == "/" ? "" : group) + "/" + name;
    read_attributes(file, path);
    if (file.is_group(path)) {
      read_group(file, path, depth + 1);
    } else {
      read_through(file, path);
    }
  }
}

const KnownChildReading all_of_hdf5("hdf5", [](const std::vector<std::string>& words) {
  const std::filesystem::path path = words.at(0);
  const File file = File::open(path, {path, words.at(1)});
  read_attributes(file, "/");
  read_group(file, "/", 0);
  return std::string();
});

}  // namespace

TrustedFile open_trusted(const std::filesystem::path& path, const Naming& naming) {
  if (!std::filesystem::exists(path)) return {File::open(path, naming), false};  // says that it is not there
  const bool sealed = check_seal(path, naming.mend);
  if (!sealed) read_in_child({.name = "hdf5", .words = {naming.mend}, .file = path, .mend = naming.mend});
  return {File::open(path, naming), sealed};
}

void expect_seal(const TrustedFile& trusted) {
  if (!trusted.sealed)
    trusted.file.refuse("is damaged", "its checksum is missing: another program changed it, or its end is lost");
}

}  // namespace talus::h5
