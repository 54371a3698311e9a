// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters written block by block.
#include "common/gis/crs.hpp"
#include "common/gis/raster_writer.hpp"
#include "common/gis/read_raster.hpp"

#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

/// What of a raster lies in a window.
Raster part_of(const Raster& whole, int column, int row, int columns, int rows) {
  Raster part{{columns, rows, whole.grid.west + column * whole.grid.cell, whole.grid.south + row * whole.grid.cell,
               whole.grid.cell, whole.grid.crs_wkt},
              {}};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) part.values.push_back(whole.at(column + c, row + r));
  return part;
}

TEST(RasterWriter, blocks_make_the_raster) {
  test::Scratch scratch;
  Raster whole = test::random_raster({70, 50, 4e5, 5e6, 2.5, test::epsg(32633)}, 3);
  whole.at(3, 4) = std::nan("");
  RasterWriter writer(scratch / "a.tif", whole.grid, {"something [m]", "m", {{"SOURCE", "test"}}});
  writer.write(part_of(whole, 0, 0, 40, 50));
  writer.write(part_of(whole, 40, 0, 30, 20));
  writer.write(part_of(whole, 40, 20, 30, 30));
  EXPECT_FALSE(std::filesystem::exists(scratch / "a.tif")) << "it has its name before it is whole";
  writer.set_item("LATER", "7");
  writer.finish();
  const Raster read = read_raster(scratch / "a.tif");
  ASSERT_EQ(read.values.size(), whole.values.size());
  EXPECT_EQ(crs_name(read.grid.crs_wkt), "EPSG:32633");
  EXPECT_EQ(read.grid.west, whole.grid.west);
  for (std::size_t i = 0; i < read.values.size(); ++i) {
    if (std::isnan(whole.values[i])) {
      EXPECT_TRUE(std::isnan(read.values[i]));
    } else {
      EXPECT_EQ(read.values[i], static_cast<double>(static_cast<float>(whole.values[i])));
    }
  }
}

TEST(RasterWriter, refuses_a_part_that_lies_outside_and_a_folder_that_is_not_there) {
  test::Scratch scratch;
  const Raster whole = test::random_raster({10, 10, 0, 0, 1, ""}, 3);
  RasterWriter writer(scratch / "a.tif", whole.grid, {});
  EXPECT_THROW(writer.write(test::random_raster({10, 10, 5, 0, 1, ""}, 3)), DataError);
  EXPECT_THROW(RasterWriter(scratch / "no" / "b.tif", whole.grid, {}), DataError);
}

}  // namespace
}  // namespace talus
