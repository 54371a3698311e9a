// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>

#include "common/gis/crs.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"
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

struct RasterFile : test::Workshop {
  std::string fault(const std::string& file) const {
    return data_fault([&] { read_raster(scratch / file); });
  }
  /// The command a fault proposes, run as it stands; `made` is what it writes.
  Raster mended(const std::string& fault_text, const std::string& made) const {
    const std::size_t at = fault_text.find(": gdal");
    EXPECT_NE(at, std::string::npos) << fault_text;
    if (at != std::string::npos) shell(fault_text.substr(at + 2));
    return read_raster(scratch / made);
  }
  std::filesystem::path ascii(const std::string& header, const std::string& cells) {
    return scratch.write("dem.asc", header + "\n" + cells);
  }
};

TEST_F(RasterFile, round_trip_keeps_every_bit_and_nodata) {
  Raster raster = random_raster({7, 5, 500000.25, 5500000.5, 2.5, epsg(32611)}, 1);
  raster.at(3, 2) = std::nan("");
  for (const auto& write : {write_cog, write_geotiff}) {
    write(scratch / "a.tif", raster, {"deposit thickness, vertical [m]", "m", {{"CONVENTION", "vertical"}}});
    const Raster back = read_raster(scratch / "a.tif");
    EXPECT_TRUE(identical(back, raster));
    EXPECT_TRUE(same_crs(back.grid.crs_wkt, raster.grid.crs_wkt));
    EXPECT_EQ(scratch.files(), 1u);
  }
}

TEST_F(RasterFile, of_several_bands_is_refused_and_one_with_a_mask_is_not) {
  const auto write = [&](const std::vector<std::string>& colours, const char* type = "Byte") {
    std::string bands;
    for (std::size_t b = 0; b < colours.size(); ++b)
      bands += fmt::format("<VRTRasterBand dataType=\"{}\" band=\"{}\"><ColorInterp>{}</ColorInterp></VRTRasterBand>",
                           type, b + 1, colours[b]);
    scratch.write("picture.vrt",
                  "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><GeoTransform>0,10,0,30,0,-10"
                  "</GeoTransform>" +
                      bands + "</VRTDataset>");
  };
  write({"Red", "Green", "Blue"});
  EXPECT_EQ(
      fault("picture.vrt"),
      "./picture.vrt: it has 3 bands (a picture, or several quantities or times: which one is meant is not said). "
      "Take one of them: gdal_translate -b 1 ./picture.vrt out.tif");
  write({"Red", "Green", "Blue", "Alpha"});
  EXPECT_TRUE(holds(fault("picture.vrt"), {"3 bands"}));
  write({"Gray", "Alpha"});
  const std::string masked = fault("picture.vrt");
  EXPECT_FALSE(holds(masked, {"bands"})) << "its cells are all masked, and that is said";
  write({"Gray", "Alpha"}, "Float32");
  EXPECT_EQ(fault("picture.vrt"), masked);
  write({"Gray"});
  EXPECT_EQ(read_raster(scratch / "picture.vrt").grid.columns, 4);
}

TEST_F(RasterFile, a_large_cog_has_overviews_and_passes_gdals_own_validator) {
  TALUS_NEED_TOOL(TALUS_COG_VALIDATOR);
  Raster raster = random_raster({1300, 1100, 500000, 5500000, 2, epsg(32611)}, 3);
  for (int row = 0; row < 300; ++row)
    for (int column = 0; column < 700; ++column) raster.at(column, row) = std::nan("");
  write_cog(scratch / "large.tif", raster, {"z", "m", {}});
  test::expect_valid_cog(scratch / "large.tif");
  EXPECT_TRUE(
      holds(test::output_of("gdalinfo '" + file("large.tif") + "'"), {"Overviews: 650x550, 325x275", "Block=512x512"}));
}

TEST_F(RasterFile, a_small_cog_is_one_tile_no_larger_than_it_needs_and_valid) {
  TALUS_NEED_TOOL(TALUS_COG_VALIDATOR);
  const auto info_of = [&](int columns, int rows) {
    const Raster raster = random_raster({columns, rows, 0, 0, 20, epsg(32611)}, 4);
    write_cog(scratch / "small.tif", raster, {"z", "m", {}});
    test::expect_valid_cog(scratch / "small.tif");
    EXPECT_TRUE(identical(read_raster(scratch / "small.tif"), raster));
    return test::output_of("gdalinfo '" + file("small.tif") + "'");
  };
  for (const auto& [columns, rows, side] : {std::array{3, 2, 128}, {201, 201, 208}, {130, 500, 512}}) {
    const std::string info = info_of(columns, rows);
    EXPECT_TRUE(holds(info, {fmt::format("Block={0}x{0}", side)}));
    EXPECT_FALSE(holds(info, {"Overviews"}));
  }
}

TEST_F(RasterFile, local_coordinates_stay_local_and_a_raster_stored_south_first_reads_the_same) {
  const Raster local = random_raster({3, 2, -1, -2, 0.5, ""}, 2);
  write_cog(scratch / "a.tif", local, {"z", "m", {}});
  EXPECT_EQ(read_raster(scratch / "a.tif").grid.crs_wkt, "");
  const Raster raster = random_raster({4, 3, 100, 200, 10, epsg(32611)}, 4);
  write_geotiff(scratch / "north.tif", raster, {"z", "m", {}});
  const auto vrt = scratch.write("south.vrt", test::south_first_vrt("north.tif", raster.grid));
  const Raster back = read_raster(vrt);
  EXPECT_EQ(back.grid.south, 200);
  EXPECT_EQ(back.values, raster.values);
}

TEST_F(RasterFile, a_large_map_gets_overviews_and_says_what_it_is) {
  Raster raster = random_raster({1100, 700, 0, 0, 10, epsg(32611)}, 3);
  write_cog(scratch / "a.tif", raster, {"deposit thickness, vertical [m]", "m", {{"THICKNESS", "vertical"}}});
  shell("gdalinfo a.tif");
  const std::string info = test::text_of(scratch / "log.txt");
  EXPECT_TRUE(
      holds(info, {"LAYOUT=COG", "COMPRESSION=DEFLATE", "Overviews: 550x350", "NoData Value=-9999", "Type=Float64",
                   "Description = deposit thickness, vertical [m]", "Unit Type: m", "THICKNESS=vertical"}));
  EXPECT_TRUE(identical(read_raster(scratch / "a.tif"), raster));
}

TEST_F(RasterFile, row_zero_is_the_southernmost) {
  const Raster raster = read_raster(
      ascii("ncols 2\nnrows 3\nxllcorner 10\nyllcorner 20\ncellsize 5\nNODATA_value -1", "1 2\n3 -1\n5 6\n"));
  EXPECT_EQ(raster.grid.columns, 2);
  EXPECT_EQ(raster.grid.rows, 3);
  EXPECT_EQ(raster.grid.west, 10);
  EXPECT_EQ(raster.grid.south, 20);
  EXPECT_EQ(raster.grid.cell, 5);
  EXPECT_EQ(raster.at(0, 0), 5);
  EXPECT_EQ(raster.at(1, 0), 6);
  EXPECT_EQ(raster.at(0, 2), 1);
  EXPECT_TRUE(std::isnan(raster.at(1, 1)));
}

TEST_F(RasterFile, undeclared_nodata_values_are_dropped_with_a_warning) {
  testing::internal::CaptureStderr();
  const Raster raster = read_raster(ascii("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 4", "-9999 7\n"));
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(), {"dem.asc: 1 cell holds -9999 or the like"}));
  EXPECT_TRUE(std::isnan(raster.at(0, 0)));
  EXPECT_EQ(raster.at(1, 0), 7);
}

TEST_F(RasterFile, scale_offset_and_single_precision_nodata_are_applied) {
  write_geotiff(scratch / "a.tif", small_raster({2, 1, 0, 0, 1, epsg(32611)}, {10, std::nan("")}), {"z", "m", {}});
  shell("gdal_translate -a_scale 0.5 -a_offset 100 a.tif b.tif");
  const Raster raster = read_raster(scratch / "b.tif");
  EXPECT_EQ(raster.at(0, 0), 105);
  EXPECT_TRUE(std::isnan(raster.at(1, 0)));
  shell("gdalwarp -ot Float32 -dstnodata -3.4028234663852886e+38 a.tif e.tif");
  EXPECT_TRUE(std::isnan(read_raster(scratch / "e.tif").at(1, 0)));
  shell(
      "gdal_translate -ot Float32 -a_nodata -9999.9 a.tif c.tif && gdalwarp -ot Float32 -dstnodata -9999.9 a.tif "
      "d.tif");
  EXPECT_TRUE(std::isnan(read_raster(scratch / "d.tif").at(1, 0)));
}

TEST_F(RasterFile, a_crs_in_the_file_beside_counts) {
  const auto file = ascii("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 4\nNODATA_value -1", "5 7\n");
  shell("gdalsrsinfo -o wkt_esri EPSG:32611 | sed /^$/d > dem.prj");
  EXPECT_TRUE(same_crs(read_raster(file).grid.crs_wkt, epsg(32611)));
  shell(
      "gdal_create -outsize 2 2 -bands 1 -burn 5 -a_srs EPSG:32612 -a_ullr 0 20 20 0 a.tif && gdal_translate -of PNG "
      "a.tif a.png");
  EXPECT_TRUE(same_crs(read_raster(scratch / "a.png").grid.crs_wkt, epsg(32612)));
}

TEST_F(RasterFile, reading_leaves_nothing_beside_the_file) {
  const auto file = ascii("ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 4\nNODATA_value -1", "5 7\n");
  read_raster(file);
  EXPECT_EQ(scratch.files(), 1u);
}

TEST_F(RasterFile, refuses_a_missing_file) {
  EXPECT_EQ(fault("none.tif"), "./none.tif: no such file. Check the path in the recipe");
}

TEST_F(RasterFile, refuses_what_is_no_raster) {
  const auto file = scratch.write("notes.tif", "these are words");
  testing::internal::CaptureStderr();
  const std::string text = fault(file);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // GDAL itself must stay quiet
  EXPECT_TRUE(begins(text, "./notes.tif: not a raster that can be read ("));
  EXPECT_TRUE(text.ends_with(". Look at it: gdalinfo ./notes.tif")) << text;
}

TEST_F(RasterFile, refuses_degrees_and_feet_with_the_command_that_mends_them) {
  write_geotiff(scratch / "d.tif", random_raster({40, 40, -114.4, 49.5, 0.001, epsg(4326)}, 5), {"z", "m", {}});
  const std::string text = fault("d.tif");
  EXPECT_EQ(text,
            "./d.tif: CRS is EPSG:4326, in degrees (this stage needs metres). Reproject: gdalwarp -t_srs EPSG:32611 -r "
            "bilinear ./d.tif d_utm.tif");
  EXPECT_EQ(crs_name(mended(text, "d_utm.tif").grid.crs_wkt), "EPSG:32611");
  write_geotiff(scratch / "f.tif", random_raster({20, 20, 6000000, 2000000, 30, epsg(2227)}, 6), {"z", "m", {}});
  const std::string feet = fault("f.tif");
  EXPECT_EQ(feet,
            "./f.tif: CRS is EPSG:2227, in US survey foot (this stage needs metres). Reproject: gdalwarp -t_srs "
            "EPSG:32610 -r bilinear ./f.tif f_utm.tif");
  EXPECT_EQ(crs_name(mended(feet, "f_utm.tif").grid.crs_wkt), "EPSG:32610");
}

TEST_F(RasterFile, refuses_rotated_rasters_and_cells_that_are_not_square_with_the_command_that_mends_them) {
  write_geotiff(scratch / "n.tif", random_raster({20, 20, 500000, 5500000, 10, epsg(32611)}, 7), {"z", "m", {}});
  shell(
      "gdal_translate -of VRT n.tif r.vrt && sed -i 's|<GeoTransform>.*</GeoTransform>|<GeoTransform>500000, 9, 3, "
      "5500200, 3, -9</GeoTransform>|' r.vrt");
  const std::string text = fault("r.vrt");
  EXPECT_EQ(text,
            "./r.vrt: rows and columns do not run east and north (this stage needs a raster that is not rotated or "
            "mirrored). Turn it: gdalwarp -r bilinear ./r.vrt r_north_up.tif");
  EXPECT_GT(mended(text, "r_north_up.tif").grid.columns, 20);
  shell("gdal_translate -a_ullr 500000 5500200 500400 5500000 n.tif w.tif");
  const std::string oblong = fault("w.tif");
  EXPECT_EQ(oblong,
            "./w.tif: cells are 20 x 10 (this stage needs square cells). Resample: gdalwarp -tr 10 10 -r bilinear "
            "./w.tif w_square.tif");
  EXPECT_EQ(mended(oblong, "w_square.tif").grid.columns, 40);
}

TEST_F(RasterFile, refuses_rasters_without_a_place_or_any_value) {
  shell("gdal_create -of GTiff -outsize 4 4 -bands 1 -ot Float32 -burn 7 p.tif");
  EXPECT_EQ(fault("p.tif"),
            "./p.tif: has no georeference (where its cells lie is not known). Give its edges: gdal_translate -a_ullr "
            "WEST NORTH EAST SOUTH ./p.tif p_placed.tif");
  ascii("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 4\nNODATA_value -9999", "-9999 -9999\n-9999 -9999\n");
  EXPECT_EQ(fault("dem.asc"),
            "./dem.asc: no cell holds a value (all 2 x 2 cells are nodata). Check the file and its nodata value: "
            "gdalinfo -stats ./dem.asc");
}

TEST_F(RasterFile, refuses_infinite_values_by_place_and_a_file_cut_short) {
  const double inf = std::numeric_limits<double>::infinity();
  write_geotiff(scratch / "i.tif", small_raster({2, 2, 100, 200, 10, epsg(32611)}, {1, 2, 3, inf}), {"z", "m", {}});
  EXPECT_TRUE(begins(fault("i.tif"), "./i.tif: column 2, line 1 (x 115.00, y 215.00) is infinite ("));
  write_geotiff(scratch / "t.tif", random_raster({200, 200, 0, 0, 10, epsg(32611)}, 9), {"z", "m", {}});
  std::filesystem::resize_file(scratch / "t.tif", std::filesystem::file_size(scratch / "t.tif") * 2 / 3);
  EXPECT_NE(fault("t.tif"), "");
}

TEST_F(RasterFile, a_full_disk_and_a_folder_that_is_not_there_are_faults_and_leave_no_half_map) {
  const Raster raster = random_raster({300, 300, 0, 0, 10, epsg(32611)}, 10);
  for (const auto& write : {write_cog, write_geotiff}) {
    const std::string text = full_disk_fault(100000, [&] { write(scratch / "a.tif", raster, {"z", "m", {}}); });
    EXPECT_TRUE(begins(text, "./a.tif: cannot be written ("));
    EXPECT_EQ(scratch.files(), 0u);
  }
  const std::string gone = data_fault([] {
    write_cog("/no/such/a.tif", random_raster({2, 2, 0, 0, 1, ""}, 11), {"z", "m", {}});
  });
  EXPECT_TRUE(begins(gone, "/no/such/a.tif: cannot be written ("));
}

TEST(Crs, the_same_system_is_recognised_in_other_words_and_names_are_short) {
  EXPECT_TRUE(same_crs("", ""));
  EXPECT_FALSE(same_crs("", epsg(32611)));
  EXPECT_TRUE(same_crs(epsg(32611), epsg(32611)));
  EXPECT_FALSE(same_crs(epsg(32611), epsg(32612)));
  const std::string esri =
      R"(PROJCS["WGS_1984_UTM_Zone_11N",GEOGCS["GCS_WGS_1984",)"
      R"(DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
      R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)"
      R"(PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",-117.0],)"
      R"(PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])";
  EXPECT_TRUE(same_crs(esri, epsg(32611)));
  EXPECT_EQ(crs_name(""), "local metric coordinates");
  EXPECT_EQ(crs_name(epsg(32149)), "EPSG:32149");
}

TEST(RasterWriter, blocks_make_the_raster) {
  test::Scratch scratch;
  Raster whole = test::random_raster({70, 50, 4e5, 5e6, 2.5, test::epsg(32633)}, 3);
  whole.at(3, 4) = std::nan("");
  RasterWriter writer(scratch / "a.tif", whole.grid, {"something [m]", "m", {{"SOURCE", "test"}}});
  writer.write(cut(whole, {0, 0, 40, 50}));
  writer.write(cut(whole, {40, 0, 30, 20}));
  writer.write(cut(whole, {40, 20, 30, 30}));
  EXPECT_FALSE(std::filesystem::exists(scratch / "a.tif")) << "it has its name before it is whole";
  writer.set_item("LATER", "7");
  writer.finish();
  const Raster read = read_raster(scratch / "a.tif");
  ASSERT_EQ(read.values.size(), whole.values.size());
  EXPECT_EQ(crs_name(read.grid.crs_wkt), "EPSG:32633");
  EXPECT_EQ(read.grid.west, whole.grid.west);
  for (std::size_t i = 0; i < read.values.size(); ++i)
    if (std::isnan(whole.values[i]))
      EXPECT_TRUE(std::isnan(read.values[i]));
    else
      EXPECT_EQ(read.values[i], static_cast<double>(static_cast<float>(whole.values[i])));
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
