// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a table of points: as many x as y as z, or refused by line.
#include "preprocess/terrain/point_table.hpp"

#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(point_table) {
  using namespace talus::preprocess;
  const talus::fuzz::InputFile file(bytes, ".csv");
  talus::fuzz::expect_result_or_error([&] {
    const ScatteredPoints points = read_point_table(file.path(), PointHeights::depths_or_elevations);
    if (points.x.size() != points.y.size() || points.x.size() != points.z.size())
      throw std::logic_error("columns of different lengths");
  });
}
