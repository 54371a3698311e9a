// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The vertical axis of every elevation model that a recipe names: its unit makes no other volume, and two models have
// one vertical datum.
#include "common/gis/crs.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/heights.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::holds;

struct vertical : test::WithScene {
  const std::string utm = crs_by_name("EPSG:32632");

  std::filesystem::path in(const std::string& name, const Raster& heights, const std::string& crs, double metres = 1) {
    Raster stored = heights;
    for (double& z : stored.values) z /= metres;
    return test::write_in_crs(scratch, name, stored, crs);
  }
  /// The three ways that name two elevation inputs, each with the first in one CRS and the second in another.
  void before_and_after(const std::string& one, const std::string& other, double metres = 1) {
    options.before_dem = in("b", before, one, metres);
    options.after_dem = in("a", after, other, metres);
  }
  void before_and_surface(const std::string& one, const std::string& other, double metres = 1) {
    before_and_after(one, other, metres);
    options.sliding_surface = options.after_dem;
    options.after_dem.clear();
  }
  void before_and_points(const std::string& one, const std::string& other, double metres = 1) {
    before_and_after(one, other, metres);
    options.after_dem.clear();
    source_outline(test::rectangle(grid.west + 80, grid.south + 110, grid.west + 180, grid.south + 230));
    const double x = grid.west + 130, y = grid.south + 170;
    options.source.sliding_surface.depth_points = test::points_in_crs(
        scratch, fmt::format("{},{},{:.9f}\n", x, y, (value_at(before, x, y) - 12) / metres), other);
  }
};

TEST_F(vertical, units_of_all_kinds_give_one_volume) {
  using Way = void (vertical::*)(const std::string&, const std::string&, double);
  for (const Way way : {&vertical::before_and_after, &vertical::before_and_surface, &vertical::before_and_points}) {
    options = Scene().options;
    (this->*way)(utm, utm, 1);
    const double volume = prepare().total.volume;
    for (const auto& [unit, metres] : {std::pair{"metre", 1.0}, {"foot", 0.3048}, {"US survey foot", 1200.0 / 3937}})
      for (const std::string& crs : {test::three_axes(unit, metres), test::compound(utm, unit, metres)}) {
        (this->*way)(crs, crs, metres);
        EXPECT_NEAR(prepare().total.volume / volume, 1, 1e-6) << unit << " " << crs.substr(0, 11);
      }
  }
  options = Scene().options;
  as_release().thickness_raster = test::write(scratch, "bowl.tif", {{bowl.grid}, bowl.values});
  options.base_dem = in("base", before, test::three_axes("foot", 0.3048), 0.3048);
  options.release[0].thickness_raster = in("thickness", bowl, utm);
  EXPECT_NEAR(prepare().total.volume, test::volume_of(bowl), 1e-6 * test::volume_of(bowl))
      << "a thickness has no datum";
}

TEST_F(vertical, datums_of_every_pair_are_compared) {
  using Way = void (vertical::*)(const std::string&, const std::string&, double);
  const std::string ellipsoidal = test::three_axes(), geoid = test::compound(utm);
  for (const Way way : {&vertical::before_and_after, &vertical::before_and_surface, &vertical::before_and_points}) {
    options = Scene().options;
    for (const auto& [one, other] : {std::pair{ellipsoidal, geoid}, {geoid, ellipsoidal}}) {
      (this->*way)(one, other, 1);
      EXPECT_TRUE(holds(data_fault(), {"EGM96 geoid", "ellipsoid of World Geodetic System 1984", "./b.vrt",
                                       "different-vertical-datums"}));
      options.accept.push_back("different-vertical-datums");
      EXPECT_GT(prepare().total.volume, 0);
      options.accept.pop_back();
    }
    (this->*way)(geoid, utm, 1);
    EXPECT_GT(prepare().total.volume, 0) << "one alone is advised of";
  }
}

}  // namespace
}  // namespace talus::preprocess
