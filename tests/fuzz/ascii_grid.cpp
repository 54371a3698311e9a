// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an ASCII grid: put right for GDAL, or refused by line.
#include "common/gis/ascii_grid.hpp"

#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(ascii_grid) {
  const talus::fuzz::InputFile file(bytes, ".asc");
  talus::fuzz::expect_result_or_error([&] {
    talus::gdal::begins_as_ascii_grid(file.path());
    const talus::gdal::AsciiGrid grid(file.path());
    if (grid.is_one() && grid.path().empty()) throw std::logic_error("a grid that GDAL cannot open");
  });
}
