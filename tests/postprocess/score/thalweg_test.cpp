// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/thalweg.hpp"

#include <fmt/format.h>

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::small_run;

/// small_run() with its mass at columns [first, first + 4) of the release's rows at every time.
talus::Run run_with_frames(const std::vector<int>& first) {
  auto run = small_run();
  run.frames = {};
  for (std::size_t k = 0; k < first.size(); ++k) {
    run.frames.time.push_back(5.0 * static_cast<double>(k));
    run.frames.thickness.push_back(block(run.maps.grid, first[k], first[k] + 4, 10, 20, 6.0));
  }
  return run;
}

Thalweg line_of(const std::vector<std::array<double, 2>>& points) {
  Thalweg thalweg{.line = points, .distance = {0}, .given = false, .origin = ""};
  for (std::size_t i = 1; i < points.size(); ++i)
    thalweg.distance.push_back(thalweg.distance.back() +
                               std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]));
  return thalweg;
}

std::string geojson(const std::string& kind, const std::string& coordinates) {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32632"}},)"
         R"("features":[{"type":"Feature","properties":{},"geometry":{"type":")" +
         kind + R"(","coordinates":)" + coordinates + "}}]}";
}

TEST(Thalweg, follows_the_centre_of_mass_from_the_crown_to_the_farthest_deposit) {
  const auto run = run_with_frames({3, 8, 14, 20, 26, 27, 26});
  const auto thalweg = thalweg_of(run, {});
  ASSERT_GT(thalweg.line.size(), 10u);
  EXPECT_FALSE(thalweg.given);
  EXPECT_EQ(thalweg.origin, "path of the centre of mass");
  const auto& grid = run.maps.grid;
  EXPECT_EQ(thalweg.line.front()[0], grid.x(3)) << "the crown is in the release's westernmost column";
  EXPECT_EQ(thalweg.line.back()[0], grid.x(34)) << "the last column of the deposit";
  for (std::size_t i = 1; i < thalweg.line.size(); ++i) {
    EXPECT_GT(thalweg.line[i][0], thalweg.line[i - 1][0]) << "never back, though the mass sways at the end";
    EXPECT_NEAR(thalweg.distance[i] - thalweg.distance[i - 1], grid.cell, 0.1 * grid.cell);
  }
  const double middle = thalweg.line[thalweg.line.size() / 2][1];
  EXPECT_NEAR(middle, grid.south + 150, 0.5 * grid.cell) << "mid-stream: rows 10 to 19";
}

TEST(Thalweg, takes_the_way_through_the_flow_where_the_mass_hardly_moves_over_the_frames) {
  const auto run = run_with_frames({3, 4});
  const auto thalweg = thalweg_of(run, {});
  EXPECT_TRUE(test::holds(thalweg.origin, {"moves less than five cells"}));
  EXPECT_EQ(thalweg.line.front()[0], run.maps.grid.x(3));
  EXPECT_EQ(thalweg.line.back()[0], run.maps.grid.x(34));
}

TEST(Thalweg, is_empty_and_says_why_without_a_deposit) {
  auto run = small_run();
  run.maps.deposit_thickness.assign(run.maps.grid.count(), 0.0);
  const auto thalweg = thalweg_of(run, {});
  EXPECT_TRUE(thalweg.line.empty());
  EXPECT_EQ(thalweg.length(), 0);
  EXPECT_EQ(thalweg.origin, "no deposit above the threshold");
}

TEST(Thalweg, turns_a_given_line_so_that_it_begins_at_the_higher_end) {
  const test::Scratch scratch;
  Options options;
  options.thalweg =
      scratch.write("line.geojson", geojson("LineString", "[[600390,5100150],[600200,5100150],[600010,5100150]]"));
  const auto thalweg = thalweg_of(small_run(), options);
  EXPECT_TRUE(thalweg.given);
  EXPECT_EQ(thalweg.line.front()[0], 600010) << "the slope falls to the east";
  EXPECT_DOUBLE_EQ(thalweg.length(), 380);
  EXPECT_EQ(thalweg.line.size(), 39u) << "a vertex a cell";
}

TEST(Thalweg, refuses_what_is_not_one_line_over_the_run) {
  const test::Scratch scratch;
  Options options;
  const auto fault = [&](const std::string& text) {
    options.thalweg = scratch.write("line.geojson", text);
    return test::fault_of<DataError>([&] { thalweg_of(small_run(), options); });
  };
  EXPECT_TRUE(
      test::holds(fault(geojson("LineString", "[[500000,5100150],[500100,5100150]]")), {"misses the run's area"}));
  EXPECT_TRUE(test::holds(
      fault(geojson("MultiLineString", "[[[600010,5100150],[600100,5100150]],[[600200,5100150],[600300,5100150]]]")),
      {"2 lines (a thalweg is one line)"}));
  EXPECT_NE(fault(geojson("Point", "[600010,5100150]")).find("no line in layer \"line\" (it holds POINT)"),
            std::string::npos);
}

TEST(Thalweg, samples_a_map_bilinearly) {
  const MapGrid grid{.columns = 3, .rows = 2, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const std::vector<double> values{0, 10, 20, 100, 110, 120};
  const auto samples = sample_along(line_of({{5, 5}, {10, 10}, {25, 15}, {500, 5}}), grid, values);
  EXPECT_DOUBLE_EQ(samples[0], 0);
  EXPECT_DOUBLE_EQ(samples[1], 55);
  EXPECT_DOUBLE_EQ(samples[2], 120);
  EXPECT_TRUE(std::isnan(samples[3]));
}

TEST(Thalweg, measures_along_itself_and_beyond_its_ends) {
  const auto thalweg = line_of({{0, 0}, {30, 0}, {30, 40}});
  EXPECT_DOUBLE_EQ(project(thalweg, 10, 5).distance, 10);
  EXPECT_DOUBLE_EQ(project(thalweg, 10, 5).offset, 5) << "left of the way down";
  EXPECT_DOUBLE_EQ(project(thalweg, 34, 20).distance, 50);
  EXPECT_DOUBLE_EQ(project(thalweg, 34, 20).offset, -4);
  EXPECT_DOUBLE_EQ(project(thalweg, 30, 55).distance, 85);
  EXPECT_DOUBLE_EQ(project(thalweg, -7, 1).distance, -7);
}

TEST(Thalweg, follows_the_front_by_the_times_of_arrival) {
  auto run = run_with_frames({3, 8, 14});
  auto& maps = run.maps;
  const auto thalweg = line_of({{600000, 5100150}, {600400, 5100150}});
  maps.arrival_time.assign(maps.grid.count(), nan);
  const auto arrive = [&](int column, double time) { maps.arrival_time[maps.grid.index(column, 15)] = time; };
  EXPECT_TRUE(front_by_arrival(maps, thalweg, 1).time.empty()) << "nothing came anywhere";
  for (int column = 3; column < 7; ++column) arrive(column, 0);  // released
  arrive(7, 1.25);
  arrive(8, 2.5);
  arrive(2, 3);  // uphill: the front stays where it is
  arrive(9, 9.75);
  auto front = front_by_arrival(maps, thalweg, 1);
  EXPECT_EQ(front.time, (std::vector<double>{0, 1.25, 2.5, 9.75}));
  EXPECT_EQ(front.value, (std::vector<double>{65, 75, 85, 95}));
  front = front_by_arrival(maps, thalweg, 15);
  EXPECT_EQ(front.value, (std::vector<double>{65, 85, 95})) << "the last one is there whatever the step";
}

}  // namespace
}  // namespace talus::postprocess
