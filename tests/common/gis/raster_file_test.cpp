// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gdal_priv.h>
#include <sys/stat.h>

#include "common/gis/crs.hpp"
#include "common/gis/features.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/local_only.hpp"
#include "common/gis/raster_file.hpp"
#include "common/gis/resampling.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::begins;
using test::epsg;
using test::holds;
using test::identical;
using test::random_raster;
using test::small_raster;

struct Opened : test::Workshop {
  void SetUp() override { const gdal::QuietErrors starts_gdal; }
};

/// Every window of a raster must hold what the whole holds there.
void expect_windows_equal_whole(const RasterFile& file) {
  const Raster whole = file.read();
  const int width = 37, height = 23;  // no divisors of tiles or strips
  for (int row = 0; row < whole.grid.rows; row += height)
    for (int column = 0; column < whole.grid.columns; column += width) {
      const CellWindow w{column, row, std::min(width, whole.grid.columns - column),
                         std::min(height, whole.grid.rows - row)};
      const Raster part = file.read(w);
      ASSERT_DOUBLE_EQ(part.grid.x(0), whole.grid.x(column));
      ASSERT_DOUBLE_EQ(part.grid.y(0), whole.grid.y(row));
      for (int r = 0; r < w.rows; ++r)
        for (int c = 0; c < w.columns; ++c) {
          const double a = part.at(c, r), b = whole.at(column + c, row + r);
          ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << column + c << ", " << row + r;
        }
    }
}

struct Layout {
  const char *name, *command, *made;
};
std::ostream& operator<<(std::ostream& out, const Layout& layout) { return out << layout.name; }

struct Layouts : Opened, testing::WithParamInterface<Layout> {};

TEST_P(Layouts, windows_equal_the_whole) {
  Raster raster = random_raster({301, 203, 500000, 5500000, 2.5, epsg(32611)}, 1);
  for (double& value : raster.values) value = std::round(value * 8) / 8;  // so that every format keeps the bits
  for (int i = 0; i < 50; ++i) raster.at(100 + i, 90) = std::nan("");
  write_geotiff(scratch / "plain.tif", raster, {"z", "m", {}});
  scratch.write("south.vrt", test::south_first_vrt("plain.tif", raster.grid));
  shell(GetParam().command);
  const RasterFile opened(scratch / GetParam().made);
  EXPECT_TRUE(identical(opened.read(), raster));
  expect_windows_equal_whole(opened);
}

INSTANTIATE_TEST_SUITE_P(
    Every, Layouts,
    testing::Values(
        Layout{"striped", "gdal_translate -co BLOCKYSIZE=16 plain.tif a.tif", "a.tif"},
        Layout{"tiled", "gdal_translate -co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=32 plain.tif a.tif", "a.tif"},
        Layout{"deflated", "gdal_translate -co COMPRESS=DEFLATE -co PREDICTOR=3 -co TILED=YES plain.tif a.tif",
               "a.tif"},
        Layout{"lzw_single_precision", "gdal_translate -ot Float32 -co COMPRESS=LZW plain.tif a.tif", "a.tif"},
        Layout{"vrt", "gdalbuildvrt a.vrt plain.tif", "a.vrt"},
        Layout{"netcdf", "gdal_translate -of netCDF -co FORMAT=NC4C plain.tif a.nc", "a.nc"},
        Layout{"netcdf_classic", "gdal_translate -of netCDF plain.tif a.nc", "a.nc"},
        Layout{"ascii", "gdal_translate -of AAIGrid plain.tif a.asc", "a.asc"},
        Layout{"masked",
               "gdal_translate -a_nodata none -mask none plain.tif b.tif && gdal_edit.py -a_nodata -9999 b.tif",
               "b.tif"},
        Layout{"south_first", "gdalinfo south.vrt", "south.vrt"}),
    [](const auto& layout) { return std::string(layout.param.name); });

TEST_F(Opened, windows_of_a_huge_raster_take_little_memory) {
  {
    const char* const options[] = {"SPARSE_OK=YES", "TILED=YES", "COMPRESS=DEFLATE", nullptr};
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    std::unique_ptr<GDALDataset> huge(
        driver->Create(file("huge.tif").c_str(), 20000, 20000, 1, GDT_Float64, const_cast<char**>(options)));
    double corner[] = {0, 10, 0, 200000, 0, -10};
    huge->SetGeoTransform(corner);
    double value = 77;
    ASSERT_EQ(
        huge->GetRasterBand(1)->RasterIO(GF_Write, 12345, 19999 - 9876, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr),
        CE_None);
  }
  const auto peak_kilobytes = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const long before = peak_kilobytes();
  const RasterFile huge(file("huge.tif"));
  for (int row = 0; row < 20000; row += 1000) EXPECT_EQ(huge.read({0, row, 20000, 10}).at(19999, 9), 0);
  EXPECT_EQ(huge.read({12300, 9800, 100, 100}).at(45, 76), 77);
  // The whole is 3200 MB. A window is 1.6 MB; the cache of blocks may grow to 128 MB. The address sanitizer keeps as
  // much again of what was freed.
#ifdef __SANITIZE_ADDRESS__
  constexpr long most = 600 * 1024;
#else
  constexpr long most = 200 * 1024;
#endif
  EXPECT_LT(peak_kilobytes() - before, most);
}

TEST_F(Opened, a_window_beyond_the_raster_is_a_bug) {
  write_geotiff(scratch / "a.tif", random_raster({4, 3, 0, 0, 1, ""}, 2), {"z", "m", {}});
  const RasterFile opened(scratch / "a.tif");
  EXPECT_EQ(opened.read({1, 1, 3, 2}).values.size(), 6u);
  EXPECT_TRUE(opened.read({4, 3, 0, 0}).values.empty());
  for (const CellWindow& w : {CellWindow{-1, 0, 2, 2}, CellWindow{2, 0, 3, 1}, CellWindow{0, 2, 1, 2}})
    EXPECT_THROW(opened.read(w), std::out_of_range);
}

TEST_F(Opened, a_window_without_any_value_is_no_fault_but_a_raster_is) {
  Raster raster = random_raster({4, 3, 0, 0, 1, ""}, 3);
  for (int c = 0; c < 4; ++c) raster.at(c, 1) = std::nan("");
  write_geotiff(scratch / "a.tif", raster, {"z", "m", {}});
  EXPECT_TRUE(std::isnan(RasterFile(scratch / "a.tif").read({0, 1, 4, 1}).at(3, 0)));
  for (double& value : raster.values) value = std::nan("");
  write_geotiff(scratch / "b.tif", raster, {"z", "m", {}});
  const RasterFile none(scratch / "b.tif");
  EXPECT_TRUE(std::isnan(none.read({0, 0, 1, 1}).at(0, 0)));
  EXPECT_NE(data_fault([&] { none.read(); }), "");
}

TEST_F(Opened, heights_in_feet_declared_by_the_file_its_crs_or_the_recipe_become_metres) {
  write_geotiff(scratch / "h.tif", small_raster({2, 1, 0, 0, 1, epsg(32611)}, {1000, std::nan("")}), {"z", "ft", {}});
  testing::internal::CaptureStderr();
  const Raster metres = read_raster(scratch / "h.tif");
  EXPECT_TRUE(
      holds(testing::internal::GetCapturedStderr(), {"h.tif: heights are in ft, converted to metres (x 0.3048)"}));
  EXPECT_DOUBLE_EQ(metres.at(0, 0), 304.8);
  EXPECT_TRUE(std::isnan(metres.at(1, 0)));
  write_geotiff(scratch / "a.tif", small_raster({1, 1, 500000, 5500000, 1, epsg(26911)}, {1000}), {"z", "", {}});
  shell("gdal_translate -a_srs EPSG:26911+6360 a.tif h.tif");  // NAVD88 in US survey feet
  const Raster surveyed = read_raster(scratch / "h.tif");
  EXPECT_DOUBLE_EQ(surveyed.at(0, 0), 1000 * 1200.0 / 3937.0);
  EXPECT_TRUE(same_crs(surveyed.grid.crs_wkt, epsg(26911)));
  write_geotiff(scratch / "a.tif", small_raster({1, 1, 0, 0, 1, epsg(32611)}, {1000}), {"z", "ft", {}});
  const auto read_as = [&](const char* unit) { return RasterFile(scratch / "a.tif", {"", unit, ""}).read().at(0, 0); };
  EXPECT_EQ(read_as("metre"), 1000);
  EXPECT_DOUBLE_EQ(read_as("foot"), 304.8);
  EXPECT_DOUBLE_EQ(read_as("us-survey-foot"), 1000 * 1200.0 / 3937.0);
}

TEST_F(Opened, refuses_an_unknown_unit_with_the_command_that_mends_it) {
  write_geotiff(scratch / "a.tif", small_raster({1, 1, 0, 0, 1, epsg(32611)}, {1000}), {"z", "fathom", {}});
  EXPECT_EQ(data_fault([&] { read_raster(scratch / "a.tif"); }),
            "./a.tif: its values are in \"fathom\" (this unit of length is not known, and this stage needs metres). If "
            "they are metres, say so: gdal_edit.py -units m ./a.tif");
  shell("gdal_edit.py -units m " + file("a.tif"));
  EXPECT_EQ(read_raster(scratch / "a.tif").at(0, 0), 1000);
}

TEST(VerticalUnit, names_of_units_are_known_in_many_spellings) {
  for (const char* name : {"", "m", "Metre", "meters", "m above sea level", "deg", "kPa", "m/s", "m s-2", "1"})
    EXPECT_EQ(metres_in(name), 1.0) << name;
  for (const char* name : {"ft", "Foot", "feet", "international foot"}) EXPECT_EQ(metres_in(name), 0.3048) << name;
  for (const char* name : {"US survey foot", "us-survey-foot", "ft-US", "US_survey_foot", "Foot_US", "sft"})
    EXPECT_EQ(metres_in(name), 1200.0 / 3937.0) << name;
  EXPECT_EQ(metres_in("cm"), 0.01);
  EXPECT_EQ(metres_in("Decimetres"), 0.1);
  EXPECT_EQ(metres_in("fathom"), std::nullopt);
}

/// A plane over the map, written on a geographic raster (cells of two sizes), for reprojecting.
struct Geographic : Opened {
  static constexpr double west = -114.4, north = 49.6, across = 0.0004, down = 0.0002;
  void write(const char* name, double first_longitude, double nodata_at = -1) const {
    OGRSpatialReference degrees, metres;
    degrees.importFromEPSG(4326);
    metres.importFromEPSG(32611);
    for (auto* srs : {&degrees, &metres}) srs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    std::unique_ptr<OGRCoordinateTransformation> to(OGRCreateCoordinateTransformation(&degrees, &metres));
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    std::unique_ptr<GDALDataset> raster(driver->Create(file(name).c_str(), 200, 300, 1, GDT_Float64, nullptr));
    double corner[] = {first_longitude, across, 0, north, 0, -down};
    raster->SetGeoTransform(corner);
    raster->SetSpatialRef(&degrees);
    for (int line = 0; line < 300; ++line)
      for (int column = 0; column < 200; ++column) {
        double x = west + (column + 0.5) * across, y = north - (line + 0.5) * down;
        to->Transform(1, &x, &y);
        double z = line == nodata_at ? -9999 : plane(x, y);
        ASSERT_EQ(
            raster->GetRasterBand(1)->RasterIO(GF_Write, column, line, 1, 1, &z, 1, 1, GDT_Float64, 0, 0, nullptr),
            CE_None);
      }
  }
  static double plane(double x, double y) { return 5000 + 0.3 * (x - 690000) - 0.2 * (y - 5490000); }

  static bool inside(const Raster& raster, int column, int row) {
    const MapGrid& grid = raster.grid;
    if (column < 1 || row < 1 || column >= grid.columns - 1 || row >= grid.rows - 1) return false;
    for (int r = row - 1; r <= row + 1; ++r)
      for (int c = column - 1; c <= column + 1; ++c)
        if (c < 0 || r < 0 || c >= grid.columns || r >= grid.rows || std::isnan(raster.at(c, r))) return false;
    return true;
  }

  /// Cells that hold a value; each must lie on the plane.
  static std::size_t on_plane(const Raster& raster) {
    std::size_t count = 0;
    for (int row = 0; row < raster.grid.rows; ++row)
      for (int column = 0; column < raster.grid.columns; ++column) {
        const double z = raster.at(column, row), expected = plane(raster.grid.x(column), raster.grid.y(row));
        // Bilinear of a plane that is curved in degrees: far below a millimetre over 30 m. A thousandth of a source
        // cell (0.03 m, the warper's own error) on this slope is 0.01 m; along the outer half cell it repeats the last
        // value.
        if (inside(raster, column, row)) {
          EXPECT_NEAR(z, expected, 0.012) << column << ", " << row;
        }
        count += !std::isnan(z);
      }
    return count;
  }
};

TEST_F(Geographic, a_raster_in_degrees_is_reprojected_on_request) {
  write("d.tif", west);
  testing::internal::CaptureStderr();
  const RasterFile opened(scratch / "d.tif", {utm_crs_of(scratch / "d.tif"), "", ""});
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(),
                    {"d.tif: reprojected from EPSG:4326 to EPSG:32611, cells of 25 m"}));
  const MapGrid& grid = opened.grid();
  EXPECT_EQ(crs_name(grid.crs_wkt), "EPSG:32611");
  EXPECT_EQ(grid.cell, 25);  // of 28.9 x 22.2 m
  EXPECT_EQ(std::fmod(grid.west, grid.cell), 0);
  EXPECT_EQ(std::fmod(grid.south, grid.cell), 0);
  // A parallelogram of 5.8 x 6.7 km in its bounding box.
  const double cells = 5780.0 * 6670.0 / (25.0 * 25.0);
  EXPECT_NEAR(static_cast<double>(on_plane(opened.read())), cells, 0.02 * cells);
  expect_windows_equal_whole(opened);
}

TEST_F(Geographic, longitudes_of_0_to_360_degrees_are_the_same_place) {
  write("e.tif", west + 360);
  write("d.tif", west);
  EXPECT_EQ(crs_name(utm_crs_of(scratch / "e.tif")), "EPSG:32611");
  const Raster a = RasterFile(scratch / "e.tif", {epsg(32611), "", ""}).read();
  const Raster b = RasterFile(scratch / "d.tif", {epsg(32611), "", ""}).read();
  EXPECT_EQ(a.grid.west, b.grid.west);
  EXPECT_EQ(on_plane(a), on_plane(b));
}

TEST_F(Geographic, nodata_that_is_not_declared_does_not_leak_into_what_is_reprojected) {
  write("d.tif", west, 150);  // a line of -9999, undeclared
  testing::internal::CaptureStderr();
  const Raster raster = RasterFile(scratch / "d.tif", {epsg(32611), "", ""}).read();
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(), {"-9999 or the like"}));
  double lowest = 1e9;
  for (const double z : raster.values)
    if (!std::isnan(z)) lowest = std::min(lowest, z);
  EXPECT_GT(lowest, 1000);  // the plane goes down to 2900 m, and any mixture with -9999 lies far below
  // Of the line's 5780 m x 22.2 m most cells of 25 m have it as their nearest: 231 x 22.2 / 25 = 205.
  const auto holding = [](const Raster& r) {
    return std::count_if(r.values.begin(), r.values.end(), [](double z) { return !std::isnan(z); });
  };
  write("w.tif", west);
  const auto missing = holding(RasterFile(scratch / "w.tif", {epsg(32611), "", ""}).read()) - holding(raster);
  EXPECT_NEAR(static_cast<double>(missing), 205, 10);
}

TEST_F(Geographic, feet_in_the_plane_and_of_height_are_both_converted) {
  const double foot = 1200.0 / 3937.0;
  write_geotiff(scratch / "f.tif", random_raster({20, 20, 6000000, 2000000, 30, epsg(2227)}, 6), {"z", "us-ft", {}});
  const Raster raster = RasterFile(scratch / "f.tif", {utm_crs_of(scratch / "f.tif"), "", ""}).read();
  EXPECT_EQ(raster.grid.cell, 9.1);  // 30 feet are 9.144 m
  double highest = 0;
  for (const double z : raster.values)
    if (!std::isnan(z)) highest = std::max(highest, z);
  EXPECT_LT(highest, 50 * foot);
  EXPECT_GT(highest, 40 * foot);
}

TEST_F(Geographic, a_fault_in_a_cell_is_told_through_the_warper_and_refusing_degrees_offers_what_the_caller_offers) {
  Raster raster = random_raster({40, 40, -114.4, 49.5, 0.001, epsg(4326)}, 5);
  raster.at(20, 20) = std::numeric_limits<double>::infinity();
  write_geotiff(scratch / "i.tif", raster, {"z", "m", {}});
  const std::string fault = data_fault([&] { RasterFile(scratch / "i.tif", {epsg(32611), "", ""}).read(); });
  EXPECT_TRUE(begins(fault, "./i.tif: column 21, line 20 (x -114.38, y 49.52) is infinite"));
  write("d.tif", west);
  const std::string text = data_fault([&] { RasterFile(scratch / "d.tif", {"", "", "or ask for UTM"}); });
  EXPECT_TRUE(text.ends_with(" d_utm.tif; or ask for UTM")) << text;
}

TEST_F(Opened, a_raster_that_is_in_the_wanted_crs_is_read_as_it_is) {
  const Raster raster = random_raster({7, 5, 500000.3, 5500000.7, 2.5, epsg(32611)}, 9);
  write_geotiff(scratch / "a.tif", raster, {"z", "m", {}});
  EXPECT_TRUE(identical(RasterFile(scratch / "a.tif", {epsg(32611), "", ""}).read(), raster));
  EXPECT_TRUE(in_metres(scratch / "a.tif"));
}

TEST_F(Opened, utm_zones_are_those_of_the_place) {
  const auto zone = [&](double west, double south) {
    write_geotiff(scratch / "a.tif", random_raster({2, 2, west, south, 0.1, epsg(4326)}, 7), {"z", "m", {}});
    return crs_name(utm_crs_of(scratch / "a.tif"));
  };
  EXPECT_EQ(zone(8, 46), "EPSG:32632");
  EXPECT_EQ(zone(-70, -33), "EPSG:32719");
  EXPECT_EQ(zone(179.7, -40), "EPSG:32760");
  EXPECT_EQ(zone(-179.9, -40), "EPSG:32701");
  EXPECT_EQ(zone(5.3, 60.4), "EPSG:32632");  // Bergen
  EXPECT_TRUE(
      begins(data_fault([&] { zone(20, 88); }), "./a.tif: its centre, 20.1, 88.1 in EPSG:4326, lies in no UTM zone"));
}

struct LocalOnly : test::InScratch {
  std::string refusal(const std::filesystem::path& file) const {
    return data_fault([&] { RasterFile{file}; });
  }
  /// A mosaic of one source, of a size and with more XML in it.
  std::filesystem::path vrt(const std::string& source, long size = 4, const std::string& more = "") const {
    return scratch.write(
        "mosaic.vrt", fmt::format("<VRTDataset rasterXSize=\"{0}\" "
                                  "rasterYSize=\"{0}\"><GeoTransform>0,10,0,40,0,-10</GeoTransform>{2}<VRTRasterBand "
                                  "dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename "
                                  "relativeToVRT=\"1\">{1}</SourceFilename><SourceBand>1</SourceBand></SimpleSource></"
                                  "VRTRasterBand></VRTDataset>",
                                  size, source, more));
  }
};

TEST_F(LocalOnly, gdal_itself_opens_nothing_beyond_this_machine_and_mosaics_of_it_are_refused_before) {
  const gdal::QuietErrors errors;
  EXPECT_FALSE(gdal::Dataset(GDALDataset::Open("/vsicurl/http://127.0.0.1:1/a.tif")));
  for (const char* name : {"HTTP", "WMS", "PostgreSQL", "WFS", "GPSBabel"})
    EXPECT_EQ(GetGDALDriverManager()->GetDriverByName(name), nullptr) << name;
  for (const std::string source : {"/vsicurl/http://127.0.0.1:1/a.tif", "http://127.0.0.1:1/a.tif", "PG:dbname=x",
                                   "/vsizip//vsicurl/http://127.0.0.1:1/a.zip/a.tif", "/vsis3/bucket/a.tif",
                                   "/vsistdin/", "WMS:http://127.0.0.1:1/?LAYERS=a"})
    EXPECT_TRUE(holds(refusal(vrt(source)), {"it names " + source, "or give --network"}));
  EXPECT_TRUE(holds(refusal("WMS:http://127.0.0.1:1/?LAYERS=a"), {"nothing is fetched"}));
  EXPECT_TRUE(holds(data_fault([] { read_polygons("PG:dbname=x", ""); }), {"nothing is fetched"}));
}

TEST_F(LocalOnly, an_address_that_is_no_source_is_no_matter_but_more_cells_than_memory_holds_are) {
  const MapGrid grid{4, 4, 0, 0, 10, ""};
  write_geotiff(scratch / "a.tif", test::random_raster(grid, 1), {});
  const auto file = vrt("a.tif", 4, "<Metadata><MDI key=\"LICENCE\">https://example.org/by/4.0</MDI></Metadata>");
  EXPECT_EQ(refusal(file), "");
  const RasterFile large(vrt("a.tif", 2000000000));
  EXPECT_TRUE(holds(data_fault([&] { large.read(); }), {"2000000000 x 2000000000 cells (3.2e+07 TB are needed"}));
  EXPECT_EQ(data_fault([&] { large.read({0, 1999999996, 4, 4}); }), "") << "a part of it is read";
}

TEST_F(LocalOnly, pipes_are_refused_also_behind_a_mosaic_of_a_mosaic) {
  const auto pipe = scratch / "pipe.tif";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(holds(refusal(pipe), {"it is a pipe"}));
  EXPECT_TRUE(holds(data_fault([&] { read_polygons(pipe, ""); }), {"it is a pipe"}));
  vrt("pipe.tif");
  std::filesystem::rename(scratch / "mosaic.vrt", scratch / "inner.vrt");
  EXPECT_TRUE(holds(refusal(vrt("inner.vrt")), {"it is a pipe"}));
  EXPECT_FALSE(with_sidecars({pipe}).empty()) << "listed, and not waited for";
}

TEST_F(LocalOnly, cells_that_numbers_do_not_tell_apart_are_refused) {
  MapGrid grid{4, 4, 1e17, 0, 10, ""};
  EXPECT_TRUE(begins(data_fault([&] { require_told_apart(grid, "far.tif"); }),
                     "far.tif: west 1e+17, south 0, cells of 10 m (coordinates that large are 16 m apart"));
  grid.west = 5e7;
  grid.cell = 0.01;
  EXPECT_NO_THROW(require_told_apart(grid, "")) << "millimetres, on the largest maps";
  write_geotiff(scratch / "far.tif", test::random_raster({4, 4, 1e17, 0, 10, ""}, 1), {});
  EXPECT_TRUE(holds(refusal(scratch / "far.tif"), {"cannot be told from one another"}));
}

}  // namespace
}  // namespace talus
