// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of a VTK XML file as the format describes them (appended, raw, blocks of zlib), read without VTK.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/common/scratch.hpp"

namespace talus::test {

class VtkReader {
 public:
  explicit VtkReader(const std::filesystem::path& file) : text_(text_of(file)) {
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    data_ = text_.find(mark) + mark.size();
    EXPECT_GT(data_, mark.size());
    xml_ = text_.substr(0, data_);
  }
  const std::string& xml() const { return xml_; }

  /// The number of an attribute of the piece, such as NumberOfPoints.
  std::size_t count(const std::string& name) const {
    std::smatch found;
    return std::regex_search(xml_, found, std::regex(name + "=\"(\\d+)\"")) ? std::stoul(found[1]) : 0;
  }

  /// Values of the array called `name`, which must be of VTK's `type`.
  template <class T>
  std::vector<T> values(const std::string& name, const std::string& type) const {
    std::smatch found;
    const std::regex form("<DataArray type=\"" + type + "\" Name=\"" + name + "\"[^>]*offset=\"(\\d+)\"/>");
    if (!std::regex_search(xml_, found, form)) {
      ADD_FAILURE() << "no array " << name << " of type " << type;
      return {};
    }
    const std::string bytes = inflated(data_ + std::stoul(found[1]));
    std::vector<T> list(bytes.size() / sizeof(T));
    if (!list.empty()) std::memcpy(list.data(), bytes.data(), bytes.size());
    return list;
  }

 private:
  std::uint64_t number(std::size_t at) const {
    std::uint64_t value = 0;
    std::memcpy(&value, text_.data() + at, sizeof value);
    return value;
  }

  std::string inflated(std::size_t at) const {
    const std::uint64_t blocks = number(at), size = number(at + 8), last = number(at + 16);
    std::string bytes;
    std::size_t place = at + 24 + 8 * blocks;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::uint64_t packed = number(at + 24 + 8 * b);
      uLongf length = b + 1 == blocks && last > 0 ? last : size;
      std::string block(length, '\0');
      EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &length,
                           reinterpret_cast<const Bytef*>(text_.data() + place), packed),
                Z_OK);
      EXPECT_EQ(length, block.size());
      bytes += block;
      place += packed;
    }
    return bytes;
  }

  std::string text_, xml_;
  std::size_t data_ = 0;
};

}  // namespace talus::test
