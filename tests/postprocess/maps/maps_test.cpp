// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GeoTIFF, NetCDF and tables: what they hold, read by our reader and by tools that are not ours.
#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include "common/gis/crs.hpp"
#include "common/gis/outlines.hpp"
#include "common/gis/raster_file.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/maps.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/writers/job.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/rasters.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;
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

struct MapFiles : test::InScratch {
  const talus::Run run_ = small_run();
};

TEST_F(MapFiles, geotiffs_keep_the_volume_and_say_what_they_are) {
  const auto files = write_geotiffs(scratch.folder(), run_);
  ASSERT_EQ(files.size(), 5U);
  const auto deposit = read_raster(scratch / "deposit_thickness.tif");
  EXPECT_NEAR(volume_under(deposit.values, deposit.grid.cell), run_.summary.volume_final,
              1e-9 * run_.summary.volume_final);
  EXPECT_TRUE(same_crs(deposit.grid.crs_wkt, test::utm32n));
  EXPECT_EQ(deposit.grid.south, run_.maps.grid.south);
  EXPECT_EQ(deposit.at(29, 15), 6.5);
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  const auto info = output_of("gdalinfo '" + files.front().string() + "'");
  EXPECT_TRUE(
      holds(info, {"LAYOUT=COG", "vertical thickness", "Unit Type: m", "NoData Value=-9999", "Float64", "32632"}));
}

TEST_F(MapFiles, say_what_the_analyst_insisted_on) {
  TALUS_NEED_TOOL("command -v gdalinfo", "gdal-bin");
  auto run = run_;
  run.summary.findings = {test::finding(Severity::refusal, "swapped-surveys", "what rose lies higher")};
  for (const auto& file : write_geotiffs(scratch.folder(), run)) {
    EXPECT_TRUE(
        holds(output_of("gdalinfo '" + file.string() + "'"), {"ACCEPTED=swapped-surveys: what rose lies higher"}));
  }
}

TEST_F(MapFiles, geotiffs_pass_gdals_own_cog_validator) {
  TALUS_NEED_TOOL(TALUS_COG_VALIDATOR);
  for (const auto& file : write_geotiffs(scratch.folder(), run_)) test::expect_valid_cog(file);
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
  const auto file = scratch / "results.nc";
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
  const auto file = scratch / "results.nc";
  write_netcdf(file, run, {});
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  const auto header = output_of("ncdump -h '" + file.string() + "'");
  EXPECT_TRUE(holds(header, {"double deposit_thickness(y, x)"}));
  EXPECT_FALSE(holds(header, {"grid_mapping"}));
  EXPECT_FALSE(holds(header, {"time ="}));
}

TEST_F(MapFiles, netcdf_speaks_cf_as_ncdump_sees_it) {
  TALUS_NEED_TOOL("command -v ncdump", "netcdf-bin");
  const auto file = scratch / "results.nc";
  write_netcdf(file, run_, {"A test", "talus-postprocess x.toml"});
  const auto header = output_of("ncdump -h '" + file.string() + "'");
  EXPECT_TRUE(holds(
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
  const auto file = scratch / "results.nc";
  write_netcdf(file, run_, {});
  write_geotiffs(scratch.folder(), run_);
  const auto netcdf = read_raster("NETCDF:\"" + file.string() + "\":deposit_thickness");
  const auto geotiff = read_raster(scratch / "deposit_thickness.tif");
  EXPECT_TRUE(same_crs(netcdf.grid.crs_wkt, geotiff.grid.crs_wkt));
  EXPECT_TRUE(test::identical(netcdf, geotiff));
}

TEST_F(MapFiles, a_netcdf_that_cannot_be_written_is_named_and_leaves_nothing) {
  const std::string fault = full_disk_fault(4096, [&] { write_netcdf(scratch / "results.nc", run_, {}); });
  EXPECT_TRUE(test::begins(fault, "./results.nc: cannot be written"));
  EXPECT_EQ(scratch.files(), 0U);
}

std::vector<double> numbers_of(const CfProjection& projection, const std::string& name) {
  for (const auto& [key, values] : projection.numbers)
    if (key == name) return values;
  return {};
}

TEST(CfProjection, reads_both_parallels_of_a_lambert_cone_and_names_nothing_it_does_not_know) {
  const auto cone = cf_projection(crs_by_name("EPSG:2154"));  // Lambert-93
  EXPECT_EQ(cone.grid_mapping_name, "lambert_conformal_conic");
  EXPECT_EQ(numbers_of(cone, "standard_parallel"), (std::vector<double>{49, 44}));
  EXPECT_EQ(numbers_of(cone, "longitude_of_central_meridian"), std::vector<double>{3});
  EXPECT_EQ(numbers_of(cone, "false_easting"), std::vector<double>{700000});
  EXPECT_EQ(numbers_of(cone, "semi_major_axis"), std::vector<double>{6378137});
  EXPECT_TRUE(cf_projection(crs_by_name("EPSG:5514")).grid_mapping_name.empty()) << "Krovak";
  EXPECT_TRUE(cf_projection(crs_by_name("EPSG:4326")).grid_mapping_name.empty());
  EXPECT_TRUE(cf_projection("no CRS").grid_mapping_name.empty());
  EXPECT_TRUE(cf_projection("").grid_mapping_name.empty());
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

/// A slab on the slope of the small run: columns 10 to 15, rows 12 to 20, 8 m thick along the vertical.
struct Slab {
  static constexpr int from = 10, to = 16, bottom = 12, top = 21;
  static constexpr double thickness = 8;
  talus::Run run = test::small_run();
  Slab() {
    run.maps.critical_thickness = test::block(run.maps.grid, from, to, bottom, top, thickness);
    run.maps.failure_displacement = test::block(run.maps.grid, from, to, bottom, top, 1);
  }
};

using CriticalMass = test::InScratch;

TEST_F(CriticalMass, has_an_outline_where_it_is_thicker_than_the_threshold) {
  const Slab slab;
  Options options;
  options.deposit_threshold = 2;
  const auto layers = map_outlines(slab.run, options, {});
  const auto critical = std::ranges::find(layers, "critical", &OutlineLayer::name);
  ASSERT_NE(critical, layers.end());
  ASSERT_EQ(critical->features.size(), 1U);
  EXPECT_EQ(critical->features[0].name, "critical mass > 2 m");
  ASSERT_EQ(critical->features[0].polygons.size(), 1U);
  ASSERT_EQ(critical->features[0].polygons[0].rings.size(), 1U);
  double west = 1e30, east = -1e30, south = 1e30, north = -1e30;
  for (const auto& [x, y] : critical->features[0].polygons[0].rings[0])
    west = std::min(west, x), east = std::max(east, x), south = std::min(south, y), north = std::max(north, y);
  // Interpolated between the centres: 8 m fall to 0 within a cell, to 2 m within three quarters of it.
  const MapGrid& grid = slab.run.maps.grid;
  EXPECT_NEAR(west, grid.x(Slab::from) - 7.5, 1e-6);
  EXPECT_NEAR(east, grid.x(Slab::to - 1) + 7.5, 1e-6);
  EXPECT_NEAR(south, grid.y(Slab::bottom) - 7.5, 1e-6);
  EXPECT_NEAR(north, grid.y(Slab::top - 1) + 7.5, 1e-6);
}

TEST_F(CriticalMass, leaves_no_outline_and_no_surface_in_other_runs) {
  const auto run = test::small_run();
  for (const OutlineLayer& layer : map_outlines(run, {}, {})) EXPECT_NE(layer.name, "critical");
  write_gis(scratch.folder(), write_geotiffs(scratch.folder(), run), {.run = run});
  EXPECT_FALSE(std::filesystem::exists(scratch / "sliding_surface.tif"));
}

TEST_F(CriticalMass, lies_on_a_surface_as_far_below_the_ground_as_it_is_thick) {
  const Slab slab;
  write_gis(scratch.folder(), write_geotiffs(scratch.folder(), slab.run), {.run = slab.run});
  const Raster surface = read_raster(scratch / "sliding_surface.tif");
  const MapGrid& grid = slab.run.maps.grid;
  int under = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool inside = column >= Slab::from && column < Slab::to && row >= Slab::bottom && row < Slab::top;
      ASSERT_EQ(std::isfinite(surface.at(column, row)), inside) << column << " " << row;
      if (!inside) continue;
      // In single precision: 1000 m to 6e-5 m.
      ASSERT_NEAR(surface.at(column, row), slab.run.maps.before[grid.index(column, row)] - Slab::thickness, 1e-4);
      ++under;
    }
  EXPECT_EQ(under, 6 * 9);
}

TEST_F(CriticalMass, is_an_outline_of_its_area_to_other_tools) {
  TALUS_NEED_TOOL("/usr/bin/python3 -c 'from osgeo import ogr'", "python3-gdal");
  const Slab slab;
  Options options;
  options.deposit_threshold = 2;
  write_gis(scratch.folder(), write_geotiffs(scratch.folder(), slab.run), {.run = slab.run, .options = options});
  const auto said = test::output_of("/usr/bin/python3 -c \"from osgeo import ogr; d = ogr.Open('" +
                                    (scratch / "outlines.gpkg").string() +
                                    "'); l = d.GetLayerByName('critical'); print([(f.GetGeometryRef().IsValid(), "
                                    "round(f['area_m2'], 3)) for f in l])\" 2>/dev/null");
  // 50 m and 80 m between the outermost centres, 7.5 m beyond them; the corners are cut off.
  const double area = (50 + 15) * (80 + 15) - 4 * 7.5 * 7.5 / 2;
  EXPECT_TRUE(holds(said, {fmt::format("[(True, {:.1f}", area)})) << "and not " << area;
}

talus::Run watched() {
  talus::Run run;
  const auto add = [&](const char* name, const char* unit, const char* quantity, const char* place,
                       std::vector<double> values) {
    run.history.columns.push_back({name, unit, quantity, place, std::move(values)});
  };
  add("gauge_a_thickness_m", "m", "thickness", "gauge a", {0, 1.5});
  add("gauge_b-1_thickness_m", "m", "thickness", "gauge b-1", {2, 2.5});
  add("section_s_discharge_m3_s", "m3 s-1", "discharge", "section s", {0, nan});
  add("section_s_passed_m3", "m3", "volume that passed", "section s", {0, 12});
  add("time_s", "s", "", "", {0, 0.5});
  return run;
}

TEST(HistoryFiles, tables_of_places_have_a_row_for_every_record_and_place_and_none_without_records) {
  const auto tables = place_tables(watched().history);
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[0].first, "gauge");
  EXPECT_EQ(tables[0].second, "time_s,gauge,thickness_m\n0,a,0\n0,b-1,2\n0.5,a,1.5\n0.5,b-1,2.5\n");
  EXPECT_EQ(tables[1].second, "time_s,section,discharge_m3_s,passed_m3\n0,s,0,0\n0.5,s,nan,12\n");
  EXPECT_TRUE(place_tables({}).empty());
  EXPECT_FALSE(history_netcdf(talus::Run{}, "").empty());
}

TEST(HistoryFiles, netcdf_has_a_variable_for_every_column) {
  std::string bytes = history_netcdf(watched(), "");
  int file = 0, id = 0;
  ASSERT_EQ(nc_open_mem("history.nc", NC_NOWRITE, bytes.size(), bytes.data(), &file), NC_NOERR);
  double values[2];
  ASSERT_EQ(nc_inq_varid(file, "gauge_b_1_thickness_m", &id), NC_NOERR);
  ASSERT_EQ(nc_get_var_double(file, id, values), NC_NOERR);
  EXPECT_EQ(values[1], 2.5);
  char unit[16] = {}, place[16] = {};
  nc_get_att_text(file, id, "units", unit);
  nc_get_att_text(file, id, "place", place);
  EXPECT_STREQ(unit, "m");
  EXPECT_STREQ(place, "gauge b-1");
  ASSERT_EQ(nc_inq_varid(file, "section_s_discharge_m3_s", &id), NC_NOERR);
  ASSERT_EQ(nc_get_var_double(file, id, values), NC_NOERR);
  double fill = 0;
  ASSERT_EQ(nc_get_att_double(file, id, "_FillValue", &fill), NC_NOERR);
  EXPECT_EQ(values[1], fill) << "a record without a value";
  ASSERT_EQ(nc_inq_varid(file, "time", &id), NC_NOERR);
  nc_close(file);
}

}  // namespace
}  // namespace talus::postprocess
