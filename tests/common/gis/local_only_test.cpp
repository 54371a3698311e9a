// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing is fetched, and nothing waited for: what GDAL is let open.
#include <fmt/format.h>
#include <sys/stat.h>

#include "common/gis/dataset_files.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/grid_limits.hpp"
#include "common/gis/polygons.hpp"
#include "common/gis/raster_file.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

struct LocalOnly : testing::Test {
  test::Scratch scratch;

  std::string refusal(const std::filesystem::path& file) {
    return test::fault_of<DataError>([&] { RasterFile{file}; });
  }
  /// A mosaic of one source, of a size and with more XML in it.
  std::filesystem::path vrt(const std::string& source, long size = 4, const std::string& more = "") {
    return scratch.write(
        "mosaic.vrt", fmt::format("<VRTDataset rasterXSize=\"{0}\" rasterYSize=\"{0}\"><GeoTransform>0,10,0,40,0,-10"
                                  "</GeoTransform>{2}<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
                                  "<SourceFilename relativeToVRT=\"1\">{1}</SourceFilename><SourceBand>1</SourceBand>"
                                  "</SimpleSource></VRTRasterBand></VRTDataset>",
                                  size, source, more));
  }
};

TEST_F(LocalOnly, mosaics_of_what_lies_on_a_network_are_refused_before_they_are_opened) {
  for (const std::string source : {"/vsicurl/http://127.0.0.1:1/a.tif", "http://127.0.0.1:1/a.tif", "PG:dbname=x",
                                   "/vsizip//vsicurl/http://127.0.0.1:1/a.zip/a.tif", "/vsis3/bucket/a.tif",
                                   "/vsistdin/", "WMS:http://127.0.0.1:1/?LAYERS=a"}) {
    const std::string fault = refusal(vrt(source));
    EXPECT_TRUE(test::holds(fault, {"it names " + source, "or give --network"}));
  }
  EXPECT_TRUE(test::holds(refusal("WMS:http://127.0.0.1:1/?LAYERS=a"), {"nothing is fetched"}));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([] { read_polygons("PG:dbname=x", ""); }), {"nothing is fetched"}));
}

TEST_F(LocalOnly, gdal_itself_opens_nothing_beyond_this_machine) {
  const gdal::QuietErrors errors;
  EXPECT_FALSE(gdal::Dataset(GDALDataset::Open("/vsicurl/http://127.0.0.1:1/a.tif")));
  for (const char* name : {"HTTP", "WMS", "PostgreSQL", "WFS", "GPSBabel"})
    EXPECT_EQ(GetGDALDriverManager()->GetDriverByName(name), nullptr) << name;
}

TEST_F(LocalOnly, an_address_that_is_no_source_is_no_matter) {
  const MapGrid grid{4, 4, 0, 0, 10, ""};
  write_geotiff(scratch / "a.tif", test::random_raster(grid, 1), {});
  const auto file = vrt("a.tif", 4, "<Metadata><MDI key=\"LICENCE\">https://example.org/by/4.0</MDI></Metadata>");
  EXPECT_EQ(refusal(file), "");
}

TEST_F(LocalOnly, pipes_are_refused_also_behind_a_mosaic_of_a_mosaic) {
  const auto pipe = scratch / "pipe.tif";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(test::holds(refusal(pipe), {"it is a pipe"}));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { read_polygons(pipe, ""); }), {"it is a pipe"}));
  vrt("pipe.tif");
  std::filesystem::rename(scratch / "mosaic.vrt", scratch / "inner.vrt");
  EXPECT_TRUE(test::holds(refusal(vrt("inner.vrt")), {"it is a pipe"}));
  EXPECT_FALSE(with_sidecars({pipe}).empty()) << "listed, and not waited for";
}

TEST_F(LocalOnly, a_raster_of_more_cells_than_memory_holds_is_refused_with_the_numbers) {
  const MapGrid grid{4, 4, 0, 0, 10, ""};
  write_geotiff(scratch / "a.tif", test::random_raster(grid, 1), {});
  const RasterFile file(vrt("a.tif", 2000000000));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { file.read(); }),
                          {"2000000000 x 2000000000 cells (3.2e+07 TB are needed"}));
  EXPECT_EQ(test::fault_of<DataError>([&] { file.read({0, 1999999996, 4, 4}); }), "") << "a part of it is read";
}

TEST_F(LocalOnly, cells_that_numbers_do_not_tell_apart_are_refused) {
  MapGrid grid{4, 4, 1e17, 0, 10, ""};
  const std::string fault = test::fault_of<DataError>([&] { require_told_apart(grid, "far.tif"); });
  EXPECT_TRUE(fault.starts_with("far.tif: west 1e+17, south 0, cells of 10 m (coordinates that large are 16 m apart"))
      << fault;
  grid.west = 5e7;
  grid.cell = 0.01;
  EXPECT_NO_THROW(require_told_apart(grid, "")) << "millimetres, on the largest maps";
  write_geotiff(scratch / "far.tif", test::random_raster({4, 4, 1e17, 0, 10, ""}, 1), {});
  EXPECT_TRUE(test::holds(refusal(scratch / "far.tif"), {"cannot be told from one another"}));
}

}  // namespace
}  // namespace talus
