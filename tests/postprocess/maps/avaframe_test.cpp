// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Aliases for AvaFrame: names as it takes them apart, thickness normal to the slope, units, nodata.
#include "postprocess/maps/avaframe.hpp"
#include "common/gis/read_raster.hpp"

#include <regex>

#include "common/stage/stage.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

/// A run on a plane that falls 3 m over 4 m to the east: the cosine of its slope is 0.8 to the last digits. Its two
/// southernmost rows have no ground.
Run on_a_plane() {
  auto run = test::small_run();
  const auto& grid = run.maps.grid;
  for (int row = 2; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      run.maps.terrain[grid.index(column, row)] = 1000 - 7.5 * column;
  return run;
}

TEST(AvaFrame, takes_thickness_normal_to_the_slope) {
  const auto run = on_a_plane();
  const auto normal = normal_thickness(run.maps, run.maps.peak_thickness);
  const auto& grid = run.maps.grid;
  for (int row = 10; row < 20; ++row)
    for (int column = 3; column < 35; ++column)
      ASSERT_NEAR(normal[grid.index(column, row)], 3 * 0.8, 1e-12)
          << column << " " << row << ": rounding of a square root";
}

TEST(AvaFrame, gives_the_true_volume_back_over_the_area_of_the_slope) {
  const auto run = on_a_plane();
  double volume = 0;
  const double slope_area = 100 / 0.8;  // of a cell [m2]
  for (const double h : normal_thickness(run.maps, run.maps.initial_thickness)) volume += h * slope_area;
  EXPECT_NEAR(volume, 24000, 1e-6);
}

TEST(AvaFrame, takes_names_apart_at_underscores) {
  auto run = on_a_plane();
  run.summary.scene = "upper_slide no. 2";
  const std::regex form("rel([^_]+)_([0-9a-f]{10})_C_([SML])_(null|ent)_mpm");
  std::smatch part;
  const auto name = avaframe_name(run, "settings");
  ASSERT_TRUE(std::regex_match(name, part, form)) << name;
  EXPECT_EQ(part[1], "upper-slide-no.-2");
  EXPECT_EQ(part[3], "S") << "24 000 m3";
  EXPECT_EQ(part[4], "null");
  run.summary.volume_released = 50e3;
  run.maps.eroded_depth = run.maps.peak_thickness;
  EXPECT_TRUE(avaframe_name(run, "settings").ends_with("_C_M_ent_mpm"));
  run.summary.volume_released = 60e3;
  EXPECT_TRUE(avaframe_name(run, "settings").ends_with("_C_L_ent_mpm"));
}

TEST(AvaFrame, hashes_the_settings_and_nothing_of_the_machine) {
  const test::Scratch scratch;
  auto run = on_a_plane();
  run.summary.provenance = {{"command", "a"},
                            {"hardware", "b"},
                            {"version", "c"},
                            {"grid", "40 x 30"},
                            {"input dem.tif", "/here/dem.tif sha256 0123"}};
  scratch.write("solve.used.toml", "# wall_time_s: 3\n[solve]\ncfl = 0.5\n");
  const auto settings = settings_text(run, scratch / "run.h5");
  EXPECT_EQ(settings, "[solve]\ncfl = 0.5\ngrid = 40 x 30\ninput dem.tif = sha256 0123\n");
  scratch.write("solve.used.toml", "# wall_time_s: 4\n[solve]\ncfl = 0.5\n");
  run.summary.provenance[0].second = "elsewhere";
  run.summary.provenance[4].second = "/there/dem.tif sha256 0123";
  EXPECT_EQ(settings_text(run, scratch / "run.h5"), settings);
  scratch.write("solve.used.toml", "[solve]\ncfl = 0.4\n");
  EXPECT_NE(avaframe_name(run, settings_text(run, scratch / "run.h5")), avaframe_name(run, settings));
}

class AvaFrameFiles : public ::testing::TestWithParam<AvaFrameFormat> {};

TEST_P(AvaFrameFiles, hold_kilopascals_metres_and_metres_a_second) {
  const test::Scratch scratch;
  const auto run = on_a_plane();
  const auto files = write_avaframe(scratch.folder(), run, "cfl = 0.5\n", GetParam());
  ASSERT_EQ(files.size(), 4U);
  const char* ends[] = {"_ppr", "_pft", "_pfv"};
  const double inside[] = {880, 2.4, 20};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(files[i].stem().string().ends_with(ends[i])) << files[i];
    const auto raster = read_raster(files[i]);
    EXPECT_EQ(raster.grid.west, run.maps.grid.west);
    EXPECT_EQ(raster.grid.south, run.maps.grid.south);
    EXPECT_EQ(raster.grid.cell, run.maps.grid.cell);
    EXPECT_NEAR(raster.at(20, 15), inside[i], 1e-4) << "four decimals in text";
    EXPECT_EQ(raster.at(20, 25), 0) << "never reached";
    EXPECT_TRUE(std::isnan(raster.at(20, 1))) << "outside the domain";
  }
  EXPECT_EQ(test::text_of(files[3]), "cfl = 0.5\n");
  EXPECT_EQ(files[3].stem().string() + "_ppr", files[0].stem().string());
}

INSTANTIATE_TEST_SUITE_P(BothFormats, AvaFrameFiles, ::testing::Values(AvaFrameFormat::tif, AvaFrameFormat::asc),
                         [](const auto& format) { return format.param == AvaFrameFormat::tif ? "tif" : "asc"; });

TEST(AvaFrame, says_the_volume_both_ways) {
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  const test::Scratch scratch;
  const auto files = write_avaframe(scratch.folder(), on_a_plane(), "", AvaFrameFormat::tif);
  const auto info = test::output_of("gdalinfo '" + files[1].string() + "'");
  EXPECT_TRUE(test::holds(info, {"RELEASE_VOLUME_M3=24000", "RELEASE_VOLUME_IF_NORMAL_WERE_VERTICAL_M3=19200",
                                 "THICKNESS_CONVENTION=normal to the slope", "Unit Type: m"}));
}

}  // namespace
}  // namespace talus::postprocess
