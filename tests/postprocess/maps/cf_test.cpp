// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The NetCDF file against the list of requirements of the CF conventions, and read by tools that know them.
#include <cmath>

#include <netcdf.h>

#include "postprocess/maps/maps.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/options/options.hpp"
#include "tests/common/rasters.hpp"
#include "tests/places.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;
using test::output_of;

/// The content of a file: a map over time and texts, the second half of them in a group.
struct Content {
  std::vector<double> first = {1, -9999, std::nan(""), 4}, second = {5, 6, -0.0, 8};
  std::vector<std::string> names = {"a", "", "long name"};
  std::string unit = "m";
  std::vector<double> list = {0.1, 2};
  std::vector<int> whole = {-1, 7};

  std::string bytes() const {
    Nc nc("x.nc");
    const int time = nc.dimension("time", 2), y = nc.dimension("y", 2), x = nc.dimension("x", 2);
    const int map = nc.field("h", {time, y, x});
    nc.text(map, "units", unit);
    nc.integers(map, "counts", whole);
    nc.enter_group("more");
    const int member = nc.dimension("member", 3);
    const int name = nc.variable("name", NC_STRING, {member});
    nc.numbers(NC_GLOBAL, "list", list);
    nc.end_definitions();
    nc.put_texts(name, names);
    nc.leave_group();
    nc.put_map(map, 0, first);
    nc.put_map(map, 1, second);
    return nc.close();  // it reads back what it was given
  }
  NcRecord record() const {
    NcRecord record;
    record.values({"", "h"}, {0, 0, 0}, {1, 2, 2}, first);
    record.values({"", "h"}, {1, 0, 0}, {1, 2, 2}, second);
    record.texts({"more", "name"}, names);
    record.text({"", "h"}, "units", unit);
    record.numbers({"", "h"}, "counts", {whole.begin(), whole.end()});
    record.numbers({"more", ""}, "list", list);
    return record;
  }
};

/// The difference of a file to the record of one with a change.
template <class Change>
std::string difference(const Change& change) {
  const Content kept;
  Content given;
  change(given);
  return given.record().difference(kept.bytes());
}

TEST(NcRecord, finds_no_difference_in_a_file_that_kept_all_and_names_what_was_kept_otherwise) {
  const Content content;
  EXPECT_EQ(content.record().difference(content.bytes()), "");
  const std::string whole = content.bytes();
  EXPECT_EQ(content.record().difference(whole.substr(0, 100)), "it does not open");
  EXPECT_EQ(difference([](Content& c) { c.second[2] = 0; }), "the values of h");
  EXPECT_EQ(difference([](Content& c) { c.names[1] = "b"; }), "the texts of name");
  EXPECT_EQ(difference([](Content& c) { c.unit = "km"; }), "units of h");
  EXPECT_EQ(difference([](Content& c) { c.whole.push_back(0); }), "counts of h");
  EXPECT_EQ(difference([](Content& c) { c.list[0] += 1e-16; }), "list of more");
}

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

struct Cf : test::InScratch {
  /// Write a run; the file's name, quoted for the shell.
  std::string written(const talus::Run& run, const std::string& name) const {
    write_netcdf(scratch / name, run, {"A test", "talus-postprocess x.toml", ""});
    return " '" + (scratch / name).string() + "'";
  }
  static std::string checked(const std::string& files, const std::string& program = "check_cf.py") {
    return output_of("/usr/bin/python3 '" TALUS_SOURCE_DIR "/tests/postprocess/maps/" + program + "' " + files);
  }
  const std::filesystem::path file_ = scratch / "results.nc";
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

TEST_F(Cf, names_the_start_of_the_failure_and_gives_releases_names_that_netcdf_can_hold) {
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  write_netcdf(file_, test::small_run(), {"", "", "1903-04-29 04:10:00"});
  const auto header = output_of("ncdump -h '" + file_.string() + "'");
  EXPECT_TRUE(holds(header, {"time:units = \"seconds since 1903-04-29 04:10:00\""}));
  EXPECT_FALSE(holds(header, {"nominal"}));
  write_netcdf(file_, full_run(test::epsg(32632), 600000, 5100000), {});
  EXPECT_TRUE(holds(
      output_of("ncdump -h '" + file_.string() + "'"),
      {"double deposit_thickness_upper_scar(y, x)", "double deposit_thickness_bed_2_5(y, x)",
       "double deposit_thickness_bed_2_5_(y, x)", "double eroded_depth(y, x)", "end of release bed-2.5, vertical"}));
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
      EXPECT_FALSE(holds(said, {complaint}));
  }
  const auto grid = output_of("cdo -s sinfo '" + file_.string() + "'");
  EXPECT_TRUE(holds(grid, {"projection", "transverse_mercator", "600005 to 600395 by 10", "1970-01-01 00:00:20"}));
  const auto sum = output_of("cdo -s output -fldsum -selname,deposit_thickness '" + file_.string() + "'");
  EXPECT_NEAR(std::stod(sum) * 100, 24000, 1) << "the volume, as cdo sums it up: " << sum;
}

TEST_F(Cf, lies_in_its_place_for_gdalinfo) {
  TALUS_NEED_TOOL("gdalinfo --format netCDF", "gdal-bin with the netCDF driver");
  write_netcdf(file_, full_run(test::epsg(32632), 600000, 5100000), {});
  const auto info = output_of("gdalinfo 'NETCDF:\"" + file_.string() + "\":deposit_thickness'");
  EXPECT_TRUE(holds(info, {"Origin = (600000.000000000000000,5100300.000000000000000)",
                           "Pixel Size = (10.000000000000000,-10.000000000000000)", "ID[\"EPSG\",32632]",
                           "NoData Value=-9999", "Unit Type: m"}));
  EXPECT_FALSE(holds(info, {"arning"}));
}

}  // namespace
}  // namespace talus::postprocess
