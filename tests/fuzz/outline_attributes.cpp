// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as names and numbers of a GeoPackage: written and read back as the same number of polygons, or refused.
#include "common/gis/outlines.hpp"

#include <cstring>

#include "common/gis/polygons.hpp"
#include "tests/fuzz/target.hpp"

namespace {

/// The next word of the bytes: its length stands in front of it.
std::string next_word(talus::fuzz::Bytes& bytes) {
  if (bytes.empty()) return {};
  const std::size_t length = std::min<std::size_t>(bytes[0] % 64, bytes.size() - 1);
  std::string word(reinterpret_cast<const char*>(bytes.data()) + 1, length);
  bytes = bytes.subspan(1 + length);
  return word;
}

double next_number(talus::fuzz::Bytes& bytes) {
  double number = 0;
  const std::size_t size = std::min(bytes.size(), sizeof number);
  if (size > 0) std::memcpy(&number, bytes.data(), size);
  bytes = bytes.subspan(size);
  return number;
}

}  // namespace

TALUS_FUZZ_TARGET(outline_attributes) {
  const talus::fuzz::InputFile file({}, ".gpkg");
  const talus::MapPolygon square{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, {}, {}};
  const std::string layer = next_word(bytes), name = next_word(bytes), key = next_word(bytes);
  const double number = next_number(bytes);
  talus::fuzz::expect_result_or_error([&] {
    talus::write_outlines(file.path(), "", {{layer, {{name, {square}, {{key, number}}}}}});
    if (talus::read_polygons(file.path(), "").size() != 1) throw std::logic_error("another number of polygons");
  });
}
