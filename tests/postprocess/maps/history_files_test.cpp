// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/history_files.hpp"

#include <netcdf.h>
#include <netcdf_mem.h>

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

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

TEST(HistoryFiles, tables_of_places_have_a_row_for_every_record_and_place) {
  const auto tables = place_tables(watched().history);
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[0].first, "gauge");
  EXPECT_EQ(tables[0].second, "time_s,gauge,thickness_m\n0,a,0\n0,b-1,2\n0.5,a,1.5\n0.5,b-1,2.5\n");
  EXPECT_EQ(tables[1].second, "time_s,section,discharge_m3_s,passed_m3\n0,s,0,0\n0.5,s,nan,12\n");
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

TEST(HistoryFiles, of_a_run_without_records_are_empty) {
  EXPECT_TRUE(place_tables({}).empty());
  EXPECT_FALSE(history_netcdf(talus::Run{}, "").empty());
}

}  // namespace
}  // namespace talus::postprocess
