// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/declared_heights.hpp"

#include "common/gis/raster_file.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/heights.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::compound;
using test::egm96;
using test::epsg;
using test::holds;
using test::three_axes;

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit units[] = {{"metre", 1},      {"foot", 0.3048},    {"US survey foot", 1200.0 / 3937},
                          {"yard", 0.9144},  {"kilometre", 1000}, {"Clarke's foot", 0.3047972654},
                          {"fathom", 1.8288}};

struct declared_heights : test::Workshop {
  Raster ground(double height) const {
    return {{4, 3, 500000, 5100000, 10, epsg(32632)}, std::vector<double>(12, height)};
  }
  double height_in(const std::string& crs, double stored, const std::string& more = "",
                   const ReadOptions& how = {}) const {
    return talus::RasterFile(test::write_in_crs(scratch, "dem", ground(stored), crs, more), how).read().at(1, 1);
  }
  DeclaredHeights heights_of(const std::string& crs) const {
    return talus::RasterFile(test::write_in_crs(scratch, "dem", ground(1000), crs)).heights();
  }
};

TEST_F(declared_heights, the_unit_of_every_kind_of_vertical_axis_is_applied) {
  for (const Unit& unit : units)
    for (const std::string& crs : {three_axes(unit.name, unit.metres), compound(epsg(32632), unit.name, unit.metres),
                                   egm96(unit.name, unit.metres)})
      EXPECT_NEAR(height_in(crs, 1234.5 / unit.metres), 1234.5, 1e-6) << unit.name << " " << crs;
}

TEST_F(declared_heights, the_log_says_the_unit) {
  testing::internal::CaptureStderr();
  height_in(three_axes("US survey foot", 1200.0 / 3937), 1000);
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(), {"heights are in US survey foot", "x 0.3048006096"}));
}

TEST_F(declared_heights, the_key_goes_before_the_band_and_the_band_before_the_axis_with_a_warning) {
  const ReadOptions foot{.to_crs = {}, .vertical_unit = "foot", .or_else = {}};
  const std::string in_metres = compound(epsg(32632)), in_feet = three_axes("foot", 0.3048);
  const auto warnings = [&](const std::string& crs, double metres, const std::string& more, const ReadOptions& how) {
    return test::messages_of([&] { EXPECT_NEAR(height_in(crs, 1000, more, how), 1000 * metres, 1e-6); });
  };
  const auto by_key = warnings(in_metres, 0.3048, "", foot);
  ASSERT_EQ(by_key.size(), 1u);
  EXPECT_TRUE(holds(by_key[0], {"in foot (vertical_unit)", "the vertical axis of its CRS says metre"}));
  const auto by_band = warnings(in_feet, 1, "<UnitType>m</UnitType>", {});
  ASSERT_EQ(by_band.size(), 1u);
  EXPECT_TRUE(holds(by_band[0], {"in m (the unit of its band)", "the vertical axis of its CRS says foot"}));
  EXPECT_TRUE(warnings(in_feet, 0.3048, "", foot).empty());
  EXPECT_TRUE(
      warnings(three_axes("US survey foot", 1200.0 / 3937), 1200.0 / 3937, "<UnitType>ft</UnitType>", {}).empty())
      << "the axis says which foot";
  EXPECT_TRUE(warnings(in_feet, 0.3048, "<UnitType>unknown</UnitType>", {}).empty());
}

TEST_F(declared_heights, depths_are_refused_and_what_is_no_length_stays) {
  const std::string depths = compound(epsg(32632), "metre", 1, "down");
  EXPECT_TRUE(
      holds(data_fault([&] { height_in(depths, 1000); }), {"dem.vrt: the vertical axis of its CRS counts down"}));
  EXPECT_EQ(height_in(three_axes("foot", 0.3048), 25, "",
                      {.to_crs = {}, .vertical_unit = {}, .or_else = {}, .are_lengths = false}),
            25);
}

TEST_F(declared_heights, a_vertical_crs_alone_places_nothing) {
  const auto file = test::write_in_crs(scratch, "dem", ground(1000), "EPSG:5703");
  EXPECT_EQ(talus::RasterFile(file).grid().crs_wkt, "");
  EXPECT_EQ(talus::RasterFile(file).heights().datum, "North American Vertical Datum 1988");
}

TEST_F(declared_heights, one_datum_has_one_name_in_every_unit_and_form) {
  const auto accepted = [&](const std::string& a, const std::string& b) {
    return test::findings_of([&] { judge_vertical_datums(heights_of(a), heights_of(b)); });
  };
  EXPECT_TRUE(accepted("EPSG:32632+5773", compound(epsg(32632), "foot", 0.3048)).empty());
  EXPECT_TRUE(accepted("EPSG:32632+5703", "EPSG:32632+6360").empty());
  EXPECT_TRUE(accepted("EPSG:26911+5703", "EPSG:5703").empty());
  EXPECT_TRUE(accepted(three_axes(), three_axes("foot", 0.3048)).empty());
  EXPECT_TRUE(accepted("EPSG:32632+4979", three_axes()).empty());
  EXPECT_TRUE(accepted("EPSG:32632", epsg(32632)).empty());
  const auto half = accepted("EPSG:32632+5773", "EPSG:32632");
  ASSERT_EQ(half.size(), 1u);
  EXPECT_EQ(half[0].severity, Severity::advice);
}

TEST_F(declared_heights, other_datums_are_refused_by_name_unless_accepted) {
  const std::vector<std::string> all{three_axes(),      "EPSG:32632+5773", "EPSG:32632+3855", "EPSG:32632+5703",
                                     "EPSG:32632+7837", "EPSG:32632+5728", "EPSG:25832+4937"};
  for (const std::string& a : all)
    for (const std::string& b : all) {
      if (a == b) continue;
      const DeclaredHeights one = heights_of(a), other = heights_of(b);
      const auto judge = [&] { judge_vertical_datums(one, other); };
      EXPECT_TRUE(holds(data_fault(judge), {one.datum, other.datum, "gdalwarp -s_srs", "different-vertical-datums"}));
      EXPECT_EQ(test::findings_of(judge, {"different-vertical-datums"}).size(), 1u);
    }
}

TEST_F(declared_heights, the_command_of_the_refusal_mends_it) {
  const auto one = test::write_in_crs(scratch, "ellipsoidal", ground(1048), three_axes());
  const auto other = test::write_in_crs(scratch, "geoid", ground(1000), "EPSG:32632+5773");
  const auto heights = [](const std::filesystem::path& file) { return talus::RasterFile(file).heights(); };
  const std::string fault = test::fault_of<DataError>([&] { judge_vertical_datums(heights(one), heights(other)); });
  const std::size_t at = fault.find("gdalwarp"), end = fault.find("out.tif") + 7;
  ASSERT_NE(at, std::string::npos);
  shell(fault.substr(at, end - at));
  EXPECT_EQ(talus::RasterFile(scratch / "out.tif").heights().datum, heights(one).datum);
  EXPECT_NEAR(read_raster(scratch / "out.tif").at(1, 1), 1048, 3) << "the geoid lies 47 to 50 m up there";
}

TEST_F(declared_heights, of_a_run_are_noted_and_read_back) {
  const DeclaredHeights given = heights_of("EPSG:32632+5773");
  const DeclaredHeights back = heights_in(facts_of(given), "unused");
  EXPECT_EQ(back.datum, given.datum);
  EXPECT_EQ(back.file, given.file);
  EXPECT_EQ(back.crs_arg, "EPSG:32632+5773");
  EXPECT_EQ(heights_in({}, "the run's ground").file, "the run's ground");
}

}  // namespace
}  // namespace talus
