// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GeoTIFF and NetCDF: what they hold, read by our reader and by tools that are not ours.
#include <netcdf.h>

#include "common/gis/crs.hpp"
#include "common/gis/read_raster.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/cf_projection.hpp"
#include "postprocess/maps/geotiff.hpp"
#include "postprocess/maps/netcdf.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/rasters.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::output_of;
using test::small_run;

TEST(Fields, hold_nodata_outside_the_domain_and_zero_inside) {
  const auto run = small_run();
  const auto& grid = run.maps.grid;
  for (const auto& field : product_fields(run.maps)) {
    const auto raster = field_raster(run.maps, field);
    EXPECT_TRUE(std::isnan(raster.at(20, 1))) << field.name << " outside";
    const bool arrival = std::string(field.name) == "arrival_time";
    EXPECT_EQ(std::isnan(raster.at(20, 25)), arrival) << field.name << " inside, never reached";
    if (!arrival) {
      EXPECT_EQ(raster.values[grid.index(20, 25)], 0);
    }
  }
}

TEST(Fields, lose_no_volume_that_left_the_ground) {
  auto run = small_run();
  run.maps.deposit_thickness[run.maps.grid.index(20, 1)] = 2;  // where there is no terrain
  const auto raster = field_raster(run.maps, product_fields(run.maps).front());
  EXPECT_EQ(volume_under(raster.values, 10), 24200);
}

class MapFiles : public ::testing::Test {
 protected:
  test::Scratch scratch_;
  const talus::Run run_ = small_run();
};

TEST_F(MapFiles, geotiffs_keep_the_volume_and_say_what_they_are) {
  const auto files = write_geotiffs(scratch_.folder(), run_);
  ASSERT_EQ(files.size(), 5U);
  const auto deposit = read_raster(scratch_ / "deposit_thickness.tif");
  EXPECT_NEAR(volume_under(deposit.values, deposit.grid.cell), run_.summary.volume_final,
              1e-9 * run_.summary.volume_final);
  EXPECT_TRUE(same_crs(deposit.grid.crs_wkt, test::utm32n));
  EXPECT_EQ(deposit.grid.south, run_.maps.grid.south);
  EXPECT_EQ(deposit.at(29, 15), 6.5);
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  const auto info = output_of("gdalinfo '" + files.front().string() + "'");
  EXPECT_TRUE(test::holds(
      info, {"LAYOUT=COG", "vertical thickness", "Unit Type: m", "NoData Value=-9999", "Float64", "32632"}));
}

TEST_F(MapFiles, say_what_the_analyst_insisted_on) {
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  auto run = run_;
  run.summary.findings = {test::finding(Severity::refusal, "swapped-surveys", "what rose lies higher")};
  for (const auto& file : write_geotiffs(scratch_.folder(), run)) {
    const auto info = output_of("gdalinfo '" + file.string() + "'");
    EXPECT_TRUE(test::holds(info, {"ACCEPTED=swapped-surveys: what rose lies higher"}));
  }
}

TEST_F(MapFiles, geotiffs_pass_gdals_own_cog_validator) {
  TALUS_NEED_TOOL(TALUS_COG_VALIDATOR);
  for (const auto& file : write_geotiffs(scratch_.folder(), run_)) test::expect_valid_cog(file);
}

std::vector<double> read_variable(const std::filesystem::path& file, const char* name, std::size_t count) {
  std::vector<double> values(count, nan);
  int id = 0, variable = 0;
  EXPECT_EQ(nc_open(file.c_str(), NC_NOWRITE, &id), NC_NOERR);
  EXPECT_EQ(nc_inq_varid(id, name, &variable), NC_NOERR) << name;
  EXPECT_EQ(nc_get_var_double(id, variable, values.data()), NC_NOERR) << name;
  nc_close(id);
  return values;
}

TEST_F(MapFiles, netcdf_holds_the_same_values_and_the_frames) {
  const auto file = scratch_ / "results.nc";
  write_netcdf(file, run_, {"A test", "talus-postprocess x.toml"});
  const auto n = run_.maps.grid.count();
  const auto deposit = read_variable(file, "deposit_thickness", n);
  EXPECT_EQ(deposit[run_.maps.grid.index(29, 15)], 6.5);
  EXPECT_EQ(deposit[0], -9999) << "outside the domain";
  double volume = 0;
  for (const double h : deposit) volume += h == -9999 ? 0 : h * 100;
  EXPECT_NEAR(volume, run_.summary.volume_final, 1e-9 * volume);
  const auto frames = read_variable(file, "thickness", 2 * n);
  EXPECT_EQ(frames[run_.maps.grid.index(4, 15)], 6) << "the release at time 0";
  EXPECT_EQ(frames[n + run_.maps.grid.index(29, 15)], 6.5) << "the deposit at the end";
  EXPECT_EQ(read_variable(file, "time", 2), (std::vector<double>{0, 20}));
  EXPECT_EQ(read_variable(file, "y", 30).front(), 5100005);
}

TEST_F(MapFiles, netcdf_is_written_without_frames_and_without_crs) {
  auto run = run_;
  run.frames = {};
  run.maps.grid.crs_wkt.clear();
  const auto file = scratch_ / "results.nc";
  write_netcdf(file, run, {});
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  const auto header = output_of("ncdump -h '" + file.string() + "'");
  EXPECT_TRUE(test::holds(header, {"double deposit_thickness(y, x)"}));
  EXPECT_FALSE(test::holds(header, {"grid_mapping"}));
  EXPECT_FALSE(test::holds(header, {"time ="}));
}

TEST_F(MapFiles, netcdf_speaks_cf_as_ncdump_sees_it) {
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  const auto file = scratch_ / "results.nc";
  write_netcdf(file, run_, {"A test", "talus-postprocess x.toml"});
  const auto header = output_of("ncdump -h '" + file.string() + "'");
  EXPECT_TRUE(test::holds(
      header, {":Conventions = \"CF-1.8\"", ":institution = \"A test\"", ":source = \"Talus",
               ": talus-postprocess x.toml\"", "double thickness(time, y, x)",
               "x:standard_name = \"projection_x_coordinate\"", "time:units = \"seconds since 1970-01-01 00:00:00\"",
               "peak_speed:units = \"m s-1\"", "peak_thickness:cell_methods = \"area: mean time: maximum\"",
               "deposit_thickness:grid_mapping = \"crs\"", "deposit_thickness:_FillValue = -9999.",
               "crs:crs_wkt = \"PROJCRS", "crs:grid_mapping_name = \"transverse_mercator\"",
               "crs:longitude_of_central_meridian = 9.", "crs:scale_factor_at_central_meridian = 0.9996", "vertical"}));
}

TEST_F(MapFiles, netcdf_and_geotiff_lie_in_the_same_place_for_gdal) {
  TALUS_NEED_TOOL("gdalinfo --format netCDF", "gdal-bin with the netCDF driver");
  const auto file = scratch_ / "results.nc";
  write_netcdf(file, run_, {});
  write_geotiffs(scratch_.folder(), run_);
  const auto netcdf = read_raster("NETCDF:\"" + file.string() + "\":deposit_thickness");
  const auto geotiff = read_raster(scratch_ / "deposit_thickness.tif");
  EXPECT_TRUE(same_crs(netcdf.grid.crs_wkt, geotiff.grid.crs_wkt));
  EXPECT_TRUE(test::identical(netcdf, geotiff));
}

TEST_F(MapFiles, a_netcdf_that_cannot_be_written_is_named_and_leaves_nothing) {
  std::string fault;
  {
    const test::SmallFiles limit(4096);
    fault = test::fault_of<DataError>([&] { write_netcdf(scratch_ / "results.nc", run_, {}); });
  }
  EXPECT_TRUE(test::holds(fault, {"results.nc: cannot be written"}));
  EXPECT_EQ(scratch_.files(), 0U);
}

std::vector<double> numbers_of(const CfProjection& projection, const std::string& name) {
  for (const auto& [key, values] : projection.numbers)
    if (key == name) return values;
  return {};
}

TEST(CfProjection, reads_both_parallels_of_a_lambert_cone) {
  const auto cone = cf_projection(crs_by_name("EPSG:2154"));  // Lambert-93
  EXPECT_EQ(cone.grid_mapping_name, "lambert_conformal_conic");
  EXPECT_EQ(numbers_of(cone, "standard_parallel"), (std::vector<double>{49, 44}));
  EXPECT_EQ(numbers_of(cone, "longitude_of_central_meridian"), std::vector<double>{3});
  EXPECT_EQ(numbers_of(cone, "false_easting"), std::vector<double>{700000});
  EXPECT_EQ(numbers_of(cone, "semi_major_axis"), std::vector<double>{6378137});
}

TEST(CfProjection, gives_grads_in_degrees) {
  const auto paris = cf_projection(
      R"wkt(PROJCRS["x",BASEGEOGCRS["y",DATUM["z",ELLIPSOID["Clarke 1880 (IGN)",6378249.2,293.466021293627]],)wkt"
      R"wkt(PRIMEM["Paris",2.5969213,ANGLEUNIT["grad",0.015707963267949]]],CONVERSION["c",)wkt"
      R"wkt(METHOD["Transverse Mercator"],PARAMETER["Latitude of natural origin",50,)wkt"
      R"wkt(ANGLEUNIT["grad",0.015707963267949]],PARAMETER["False easting",5,LENGTHUNIT["metre",1]]],)wkt"
      R"wkt(CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]])wkt");
  EXPECT_EQ(paris.grid_mapping_name, "transverse_mercator");
  EXPECT_NEAR(numbers_of(paris, "latitude_of_projection_origin").at(0), 45, 1e-9);
  EXPECT_NEAR(numbers_of(paris, "longitude_of_prime_meridian").at(0), 2.33722917, 1e-8);
  EXPECT_NEAR(numbers_of(paris, "inverse_flattening").at(0), 293.466021293627, 1e-9);
}

TEST(CfProjection, names_nothing_it_does_not_know) {
  EXPECT_TRUE(cf_projection(crs_by_name("EPSG:5514")).grid_mapping_name.empty()) << "Krovak";
  EXPECT_TRUE(cf_projection(crs_by_name("EPSG:4326")).grid_mapping_name.empty());
  EXPECT_TRUE(cf_projection("no CRS").grid_mapping_name.empty());
  EXPECT_TRUE(cf_projection("").grid_mapping_name.empty());
}

}  // namespace
}  // namespace talus::postprocess
