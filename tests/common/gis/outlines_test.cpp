// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines at thresholds: areas and holes with known answers, and files read back by our reader and by ogrinfo.
#include "common/gis/outlines.hpp"
#include "common/gis/polygons.hpp"

#include <ogr_geometry.h>

#include <numbers>

#include "tests/common/rasters.hpp"
#include "tests/common/tools.hpp"

namespace talus {
namespace {

using test::Scratch;

MapGrid grid_of(int cells, double cell) {
  return {
      .columns = cells, .rows = cells, .west = 500000, .south = 5400000, .cell = cell, .crs_wkt = test::epsg(32611)};
}

/// Values by a function of the distance from the middle.
template <class Function>
Raster around_middle(const MapGrid& grid, Function&& value) {
  Raster raster{grid, {}};
  const double x = grid.west + 0.5 * grid.columns * grid.cell, y = grid.south + 0.5 * grid.rows * grid.cell;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      raster.values.push_back(value(std::hypot(grid.x(column) - x, grid.y(row) - y)));
  return raster;
}

/// 120 m high, falling by 1 m per m, on cells of 10 m: above 20 m a disc of 100 m around (500200, 5400200).
Raster cone() {
  return around_middle(grid_of(40, 10), [](double r) { return 120 - r; });
}

OGRPolygon shape_of(const MapPolygon& polygon) {
  OGRPolygon shape;
  for (const auto& ring : polygon.rings) {
    OGRLinearRing line;
    for (const auto& [x, y] : ring) line.addPoint(x, y);
    line.closeRings();
    shape.addRing(&line);
  }
  return shape;
}

TEST(OutlineAbove, has_the_area_of_a_disc) {
  // Chords of at most a cell across a circle of ten
  // cells lie inside it by cell^2 / (8 r) at most: 1.25 m of 100 m, 2.5 % of the area; the other side is open by as
  // much.
  const auto polygons = outline_above(cone(), 20);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].rings.size(), 1U);
  const double disc = std::numbers::pi * 100 * 100;
  EXPECT_NEAR(shape_of(polygons[0]).get_Area(), disc, 0.025 * disc);
}

TEST(OutlineAbove, lies_where_the_value_is_the_threshold) {
  const auto polygons = outline_above(cone(), 20);
  for (const auto& [x, y] : polygons.at(0).rings.at(0))
    EXPECT_NEAR(std::hypot(x - 500200, y - 5400200), 100, 0.3) << "the cone is bent by cell^2 / (8 r) within a cell";
}

TEST(OutlineAbove, keeps_holes_and_islands_in_them) {
  const auto rings = around_middle(grid_of(60, 5), [](double r) { return r < 30 ? 5 : r < 80 ? 0 : r < 130 ? 5 : 0; });
  const auto polygons = outline_above(rings, 1);
  ASSERT_EQ(polygons.size(), 2U) << "the ring, and the island in its hole";
  std::size_t holes = 0;
  for (const auto& polygon : polygons) {
    holes += polygon.rings.size() - 1;
    const auto shape = shape_of(polygon);
    EXPECT_TRUE(shape.IsValid());
    EXPECT_FALSE(shape.getExteriorRing()->isClockwise());
    for (int i = 0; i < shape.getNumInteriorRings(); ++i) EXPECT_TRUE(shape.getInteriorRing(i)->isClockwise());
  }
  EXPECT_EQ(holes, 1U);
}

TEST(OutlineAbove, counts_nodata_and_the_world_outside_as_nothing) {
  auto full = around_middle(grid_of(4, 10), [](double) { return 2.0; });
  full.at(1, 1) = std::nan("");
  const auto polygons = outline_above(full, 1);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].rings.size(), 2U) << "a hole where nothing is known";
  OGREnvelope box;
  shape_of(polygons[0]).getEnvelope(&box);
  EXPECT_DOUBLE_EQ(box.MinX, 500000) << "half way to the first 0, which is a cell away: the raster's own edge";
  EXPECT_TRUE(outline_above(full, 3).empty());
  EXPECT_THROW(outline_above(full, -1), std::invalid_argument);
}

/// Noise has saddles, single cells and values that are the threshold itself: all that makes polygons invalid.
TEST(OutlineAbove, gives_valid_disjoint_polygons_of_noise) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    auto noise = test::random_raster(grid_of(40, 2), seed);
    for (double& value : noise.values) value = std::floor(value / 10);
    const auto polygons = outline_above(noise, 2);
    OGRMultiPolygon all;
    for (const auto& polygon : polygons) {
      const auto shape = shape_of(polygon);
      all.addGeometry(&shape);
    }
    EXPECT_GT(polygons.size(), 10U);
    EXPECT_TRUE(all.IsValid()) << "valid as a whole: no two of them overlap either";
  }
}

class OutlineFile : public ::testing::Test {
 protected:
  void write() const {
    const auto crater = around_middle(grid_of(40, 10), [](double r) { return r < 40 ? 0 : 120 - r; });
    OutlineLayer deposit{"deposit", {}};
    for (const double level : {20.0, 60.0})
      deposit.features.push_back(
          {"above " + std::to_string(static_cast<int>(level)), outline_above(crater, level), {{"threshold_m", level}}});
    deposit.features.push_back({"nothing", {}, {}});
    write_outlines(file_, crater.grid.crs_wkt, {deposit, {"survey", {{"mapped", outline_above(crater, 40), {}}}}});
  }
  Scratch scratch_;
  const std::filesystem::path file_ = scratch_ / "outlines.gpkg";
};

TEST_F(OutlineFile, reads_back_with_holes_crs_and_attributes) {
  write();
  const auto polygons = read_polygons(file_, test::epsg(32611));
  ASSERT_EQ(polygons.size(), 2U);
  EXPECT_EQ(polygons[0].name, "above 20");
  EXPECT_EQ(polygons[0].rings.size(), 2U) << "the hole";
  EXPECT_NEAR(polygons[0].rings[0][0][0], 500200, 110);
  const auto shape = shape_of(polygons[0]);
  const std::vector<std::pair<std::string, double>> numbers{{"area_m2", shape.get_Area()}, {"threshold_m", 20}};
  ASSERT_EQ(polygons[0].numbers.size(), 2U);
  EXPECT_EQ(polygons[0].numbers[0].first, "area_m2");
  EXPECT_NEAR(polygons[0].numbers[0].second, shape.get_Area(), 1e-6) << "summed in another order";
  EXPECT_EQ(polygons[0].numbers[1], numbers[1]);
  EXPECT_EQ(scratch_.files(), 1U) << "no journal, nothing pending";
}

TEST_F(OutlineFile, is_carried_to_another_crs_by_its_own) {
  write();
  const auto there = read_polygons(file_, test::epsg(32612));
  EXPECT_LT(there.at(0).rings.at(0).at(0)[0], 100000) << "six degrees west of the central meridian of zone 12";
}

TEST_F(OutlineFile, is_what_ogrinfo_expects) {
  TALUS_NEED_TOOL("command -v ogrinfo", "gdal-bin");
  write();
  const auto info = test::output_of("ogrinfo -so -al '" + file_.string() + "'");
  EXPECT_TRUE(test::holds(info, {"Layer name: deposit", "Layer name: survey", "Geometry: Multi Polygon",
                                 "Feature Count: 2", "area_m2: Real", "threshold_m: Real", "name: String", "32611"}));
  EXPECT_FALSE(test::holds(info, {"Warning"}));
}

TEST_F(OutlineFile, without_crs_is_read_as_it_is) {
  write_outlines(file_, "", {{"all", {{"cone", outline_above(cone(), 20), {}}}}});
  EXPECT_NEAR(read_polygons(file_, test::epsg(32611)).at(0).rings.at(0).at(0)[0], 500200, 110);
}

TEST_F(OutlineFile, that_cannot_be_written_is_named_and_leaves_nothing) {
  std::string fault;
  {
    const test::SmallFiles limit(4096);
    fault = test::fault_of<DataError>([&] { write(); });
  }
  EXPECT_TRUE(test::holds(fault, {"outlines.gpkg: cannot be written"}));
  EXPECT_EQ(scratch_.files(), 0U);
}

TEST_F(OutlineFile, with_a_layer_twice_is_refused) {
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] {
                            write_outlines(file_, "", {{"a", {}}, {"a", {}}});
                          }),
                          {"outlines.gpkg: cannot be written"}));
}

}  // namespace
}  // namespace talus
