// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/nc_record.hpp"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "common/stage/checksum.hpp"

namespace talus::postprocess {
namespace {

std::string digest_of(std::span<const double> values) {
  Sha256 sum;
  const auto bytes = std::as_bytes(values);
  sum.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return sum.digest();
}

std::string name_of(const NcRecord::Place& place) {
  if (!place.variable.empty()) return place.variable;
  return place.group.empty() ? "the file" : place.group;
}

}  // namespace

/// A file in memory, opened to be read.
class NcRecord::Opened {
 public:
  explicit Opened(const std::string& bytes) {
    // The library does not write to what it opens for reading.
    if (nc_open_mem("written", NC_NOWRITE, bytes.size(), const_cast<char*>(bytes.data()), &root_) != NC_NOERR)
      root_ = -1;
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    if (root_ >= 0) nc_close(root_);
  }

  bool open() const { return root_ >= 0; }
  /// The id of a place's group; -1 where there is none.
  int group(const NcRecord::Place& place) const {
    int id = root_;
    if (!place.group.empty() && nc_inq_grp_ncid(root_, place.group.c_str(), &id) != NC_NOERR) return -1;
    return id;
  }
  /// The id of a place's variable; one that no variable has where there is none.
  int variable(const NcRecord::Place& place) const {
    if (place.variable.empty()) return NC_GLOBAL;
    int id = 0;
    return nc_inq_varid(group(place), place.variable.c_str(), &id) == NC_NOERR ? id : NC_MAX_VARS;
  }
  std::string digest(const NcRecord::Place& place, const std::vector<std::size_t>& start,
                     const std::vector<std::size_t>& count) const {
    std::vector<double> values(std::accumulate(count.begin(), count.end(), std::size_t{1}, std::multiplies<>()));
    if (nc_get_vara_double(group(place), variable(place), start.data(), count.data(), values.data()) != NC_NOERR)
      return {};
    return digest_of(values);
  }
  bool holds_texts(const NcRecord::Place& place, const std::vector<std::string>& texts) const {
    std::vector<char*> found(texts.size(), nullptr);
    if (nc_get_var_string(group(place), variable(place), found.data()) != NC_NOERR) return false;
    const bool same = std::equal(texts.begin(), texts.end(), found.begin(),
                                 [](const std::string& text, const char* other) { return other && text == other; });
    nc_free_string(found.size(), found.data());
    return same;
  }
  bool holds_text(const NcRecord::Place& place, const std::string& name, const std::string& value) const {
    std::size_t length = 0;
    if (nc_inq_attlen(group(place), variable(place), name.c_str(), &length) != NC_NOERR || length != value.size())
      return false;
    std::string found(length, '\0');
    return nc_get_att_text(group(place), variable(place), name.c_str(), found.data()) == NC_NOERR && found == value;
  }
  bool holds_numbers(const NcRecord::Place& place, const std::string& name, const std::vector<double>& values) const {
    std::size_t length = 0;
    if (nc_inq_attlen(group(place), variable(place), name.c_str(), &length) != NC_NOERR || length != values.size())
      return false;
    std::vector<double> found(length);
    return nc_get_att_double(group(place), variable(place), name.c_str(), found.data()) == NC_NOERR &&
           digest_of(found) == digest_of(values);
  }

 private:
  int root_ = -1;
};

void NcRecord::values(const Place& place, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                      std::span<const double> values) {
  checks_.emplace_back([place, start, count, digest = digest_of(values)](const Opened& file) {
    return file.digest(place, start, count) == digest ? "" : "the values of " + name_of(place);
  });
}

void NcRecord::texts(const Place& place, const std::vector<std::string>& texts) {
  checks_.emplace_back([place, texts](const Opened& file) {
    return file.holds_texts(place, texts) ? "" : "the texts of " + name_of(place);
  });
}

void NcRecord::text(const Place& place, const std::string& name, const std::string& value) {
  checks_.emplace_back([place, name, value](const Opened& file) {
    return file.holds_text(place, name, value) ? "" : fmt::format("{} of {}", name, name_of(place));
  });
}

void NcRecord::numbers(const Place& place, const std::string& name, const std::vector<double>& values) {
  checks_.emplace_back([place, name, values](const Opened& file) {
    return file.holds_numbers(place, name, values) ? "" : fmt::format("{} of {}", name, name_of(place));
  });
}

std::string NcRecord::difference(const std::string& bytes) const {
  const Opened file(bytes);
  if (!file.open()) return "it does not open";
  for (const Check& check : checks_)
    if (std::string words = check(file); !words.empty()) return words;
  return {};
}

}  // namespace talus::postprocess
