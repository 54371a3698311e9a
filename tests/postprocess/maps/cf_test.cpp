// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The NetCDF file against the list of requirements of the CF conventions, and read by tools that know them.
#include "postprocess/maps/cf_projection.hpp"
#include "postprocess/maps/netcdf.hpp"
#include "postprocess/options/options.hpp"
#include "tests/common/rasters.hpp"
#include "tests/places.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::output_of;

/// A run with all a file can hold: releases, erosion, frames.
Run full_run(const std::string& crs, double west, double south) {
  auto run = test::small_run();
  run.maps.grid.crs_wkt = crs;
  run.maps.grid.west = west;
  run.maps.grid.south = south;
  run.maps.eroded_depth = test::block(run.maps.grid, 8, 12, 10, 20, 0.5);
  run.maps.deposit_of = {{"upper scar", run.maps.deposit_thickness},
                         {"bed-2.5", run.maps.eroded_depth},
                         {"bed 2.5", run.maps.eroded_depth}};
  return run;
}

class Cf : public ::testing::Test {
 protected:
  /// Write a run; the file's name, quoted for the shell.
  std::string written(const talus::Run& run, const std::string& name) const {
    write_netcdf(scratch_ / name, run, {"A test", "talus-postprocess x.toml", ""});
    return " '" + (scratch_ / name).string() + "'";
  }
  static std::string checked(const std::string& files, const std::string& program = "check_cf.py") {
    return output_of("/usr/bin/python3 '" TALUS_SOURCE_DIR "/tests/postprocess/maps/" + program + "' " + files);
  }
  test::Scratch scratch_;
  const std::filesystem::path file_ = scratch_ / "results.nc";
};

#define TALUS_CF_CHECKER                                                                         \
  "/usr/bin/python3 -c 'import netCDF4, osgeo.gdal, ctypes; ctypes.CDLL(\"libudunits2.so.0\")'", \
      "python3-netcdf4 python3-gdal udunits-bin"

struct Place {
  const char* what;
  int epsg;
  double west, south;
};

/// Every projection that has a name in CF, by a grid somebody works in, and no CRS at all.
TEST_F(Cf, is_followed_to_the_letter_in_every_projection_it_names) {
  TALUS_NEED_TOOL(TALUS_CF_CHECKER);
  const Place places[] = {{"transverse Mercator: UTM 32N", 32632, 600000, 5100000},
                          {"Lambert conic: Washington South", 32149, 361000, 70000},
                          {"Lambert azimuthal: Europe", 3035, 4321000, 2600000},
                          {"Albers: British Columbia", 3005, 1000000, 500000},
                          {"oblique Mercator: Switzerland", 2056, 2600000, 1200000},
                          {"oblique stereographic: Netherlands", 28992, 155000, 463000},
                          {"polar stereographic, by scale: UPS North", 5041, 2100000, 1900000},
                          {"polar stereographic, by parallel: Antarctica", 3031, -1500000, 300000},
                          {"Mercator: Indonesia", 3001, 3900000, 900000}};
  auto files = written(full_run("", 0, 0), "local coordinates.nc");
  for (const auto& place : places)
    files += written(full_run(test::epsg(place.epsg), place.west, place.south), std::string(place.what) + ".nc");
  EXPECT_EQ(checked(files), "no faults\n");
}

TEST_F(Cf, is_checked_by_what_sees_every_break) {
  TALUS_NEED_TOOL(TALUS_CF_CHECKER);
  EXPECT_EQ(checked(written(full_run(test::epsg(32632), 600000, 5100000), "whole.nc"), "break_cf.py"), "no faults\n");
}

TEST_F(Cf, names_the_start_of_the_failure_where_it_is_known) {
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  write_netcdf(file_, test::small_run(), {"", "", "1903-04-29 04:10:00"});
  const auto header = output_of("ncdump -h '" + file_.string() + "'");
  EXPECT_TRUE(test::holds(header, {"time:units = \"seconds since 1903-04-29 04:10:00\""}));
  EXPECT_FALSE(test::holds(header, {"nominal"}));
}

TEST(StartTime, is_a_date_or_refused) {
  const auto faults_of = [](const std::string& text) {
    Options options;
    options.start_time = text;
    std::vector<Fault> faults;
    recipe::find_unmet(options, faults);
    return faults.size();
  };
  for (const auto* good : {"", "1903-04-29 04:10:00", "2021-02-28 23:59:59"}) EXPECT_EQ(faults_of(good), 0U) << good;
  for (const auto* bad :
       {"1903-04-29", "2021-02-29 00:00:00", "2021-02-28 24:00:00", "1580-01-01 00:00:00", "yesterday"})
    EXPECT_EQ(faults_of(bad), 1U) << bad;
}

TEST_F(Cf, is_read_by_cdo_without_complaint) {
  TALUS_NEED_TOOL("command -v cdo", "cdo");
  write_netcdf(file_, full_run(test::epsg(32632), 600000, 5100000), {});
  for (const auto* verb : {"sinfo", "infon"}) {
    int code = -1;
    const auto said = output_of("cdo -s " + std::string(verb) + " '" + file_.string() + "'", &code);
    EXPECT_EQ(code, 0) << said;
    for (const auto* complaint : {"arning", "rror", "nsupported", "nconsistent"})
      EXPECT_FALSE(test::holds(said, {complaint}));
  }
  const auto grid = output_of("cdo -s sinfo '" + file_.string() + "'");
  EXPECT_TRUE(
      test::holds(grid, {"projection", "transverse_mercator", "600005 to 600395 by 10", "1970-01-01 00:00:20"}));
  const auto sum = output_of("cdo -s output -fldsum -selname,deposit_thickness '" + file_.string() + "'");
  EXPECT_NEAR(std::stod(sum) * 100, 24000, 1) << "the volume, as cdo sums it up: " << sum;
}

TEST_F(Cf, lies_in_its_place_for_gdalinfo) {
  TALUS_NEED_TOOL("gdalinfo --format netCDF", "gdal-bin with the netCDF driver");
  write_netcdf(file_, full_run(test::epsg(32632), 600000, 5100000), {});
  const auto info = output_of("gdalinfo 'NETCDF:\"" + file_.string() + "\":deposit_thickness'");
  EXPECT_TRUE(test::holds(info, {"Origin = (600000.000000000000000,5100300.000000000000000)",
                                 "Pixel Size = (10.000000000000000,-10.000000000000000)", "ID[\"EPSG\",32632]",
                                 "NoData Value=-9999", "Unit Type: m"}));
  EXPECT_FALSE(test::holds(info, {"arning"}));
}

TEST_F(Cf, gives_releases_names_that_netcdf_can_hold) {
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  write_netcdf(file_, full_run(test::epsg(32632), 600000, 5100000), {});
  const auto header = output_of("ncdump -h '" + file_.string() + "'");
  EXPECT_TRUE(test::holds(header, {"double deposit_thickness_upper_scar(y, x)",
                                   "double deposit_thickness_bed_2_5(y, x)", "double deposit_thickness_bed_2_5_(y, x)",
                                   "double eroded_depth(y, x)", "end of release bed-2.5, vertical"}));
}

}  // namespace
}  // namespace talus::postprocess
