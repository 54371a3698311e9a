// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is written of the mass that fails first: its outline, and the surface under it.
#include <fmt/format.h>

#include "common/gis/outlines.hpp"
#include "common/gis/read_raster.hpp"
#include "postprocess/maps/geotiff.hpp"
#include "postprocess/maps/gis.hpp"
#include "postprocess/writers/job.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

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

TEST(CriticalMass, has_an_outline_where_it_is_thicker_than_the_threshold) {
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

TEST(CriticalMass, leaves_no_outline_and_no_surface_in_other_runs) {
  const test::Scratch scratch;
  const auto run = test::small_run();
  for (const OutlineLayer& layer : map_outlines(run, {}, {})) EXPECT_NE(layer.name, "critical");
  write_gis(scratch.folder(), write_geotiffs(scratch.folder(), run), {.run = run});
  EXPECT_FALSE(std::filesystem::exists(scratch / "sliding_surface.tif"));
}

TEST(CriticalMass, lies_on_a_surface_as_far_below_the_ground_as_it_is_thick) {
  const test::Scratch scratch;
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

TEST(CriticalMass, is_an_outline_of_its_area_to_other_tools) {
  TALUS_NEED_TOOL("/usr/bin/python3 -c 'from osgeo import ogr'", "python3-gdal");
  const test::Scratch scratch;
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
  EXPECT_TRUE(test::holds(said, {fmt::format("[(True, {:.1f}", area)})) << "and not " << area;
}

}  // namespace
}  // namespace talus::postprocess
