// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A slide beside larger changes of other kinds: it is found, or asked for by place.
#include "preprocess/scene/candidates.hpp"

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using Change = std::function<std::array<double, 2>(double x, double y, double z)>;  // heights before and after [m]

/// A slope of 24 degrees that rises to the east, 600 m by 400 m, with a scar of 18,100 m3, or what is left of it, and
/// its lobe 250 m below, and another change before or after it.
struct SlideBeside {
  static constexpr double west = 500000, south = 5100000, scar_x = 505, scar_y = 195;
  test::Scratch scratch;
  MapGrid grid = test::grid_of(60, 40, 10);
  Options options;

  explicit SlideBeside(const Change& other, bool has_lobe = true) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.05);
    Raster before = test::raster_of(grid, [](double, double) { return 0; }), after = before;
    for (std::size_t i = 0; i < before.values.size(); ++i) {
      const auto [column, row] = grid.cell_of(i);
      const double x = grid.x(column) - west, y = grid.y(row) - south;
      const double z = 700 + 0.45 * x + 0.002 * (y - 200) * (y - 200) + 3 * std::sin(x / 30) * std::cos(y / 40);
      const std::array<double, 2> heights = other(x, y, z);
      before.values[i] = heights[0] + noise(random);
      after.values[i] = heights[1] + noise(random) - bowl(x - scar_x, y - scar_y, 50, 6) +
                        (has_lobe ? bowl(x - 250, y - scar_y, 55, 5) : 0);
    }
    options = test::two_models(test::write(scratch, "before.tif", before), test::write(scratch, "after.tif", after));
  }
  static double bowl(double x, double y, double radius, double depth) {
    return depth * std::max(0.0, 1 - (x * x + y * y) / (radius * radius));
  }
  Prepared prepared() const { return prepare(options, Points::counted); }
  std::string fault() const {
    return test::fault_of<DataError>([&] { prepared(); });
  }
  /// The slide's own release, but for a rim thinner than threshold_m, at its place.
  void expect_slide() const {
    const Prepared found = prepared();
    EXPECT_NEAR(found.total.volume, std::numbers::pi * 50 * 50 * 6 / 2, 0.1 * found.total.volume);
    EXPECT_GT(value_at(found.domain.release_thickness, west + scar_x, south + scar_y), 5);
  }
};

std::array<double, 2> nothing(double, double, double z) { return {z, z}; }
std::array<double, 2> reservoir(double x, double, double z) {
  return x < 140 ? std::array{std::max(z, 770.0), std::max(z, 758.0)} : std::array{z, z};
}
/// 20 m of forest on the slope beside the slide.
std::array<double, 2> harvest(double x, double y, double z) {
  const bool felled = x > 350 && x < 550 && y > 270 && y < 380;
  return {z + (felled ? 20 : 0), z};
}
/// A pit of 30 m in the slope, and its spoil beside the valley's stream.
std::array<double, 2> quarry(double x, double y, double z) {
  return {z, z - SlideBeside::bowl(x - 420, y - 330, 60, 30)};
}
std::array<double, 2> spoil(double x, double y, double z) {
  return {z, quarry(x, y, z)[1] + SlideBeside::bowl(x - 80, y - 360, 60, 28)};
}
std::array<double, 2> glacier(double x, double y, double z) { return {z, z - (x > 420 && y > 265 ? 12 : 0)}; }
std::array<double, 2> snow(double, double, double z) { return {z + 1.5, z}; }

TEST(candidates, a_slide_alone_is_found) { SlideBeside(nothing).expect_slide(); }

TEST(candidates, a_slide_is_found_beside_larger_changes_that_leave_no_deposit_below) {
  for (const Change& other : {Change(reservoir), Change(harvest), Change(quarry), Change(glacier)}) {
    const SlideBeside scene(other);
    scene.expect_slide();
    const Prepared found = scene.prepared();
    const auto said = std::ranges::find(found.domain.findings, "larger-lowering", &Finding::name);
    ASSERT_NE(said, found.domain.findings.end());
    EXPECT_NE(said->message.find("m3 at [50"), std::string::npos) << said->message;
  }
}

TEST(candidates, are_asked_for_by_place_where_none_has_fall_and_a_deposit_of_its_size) {
  for (const Change& other : {Change(nothing), Change(reservoir), Change(harvest), Change(quarry), Change(glacier)}) {
    const SlideBeside scene(other, false);  // the deposit fell into a river
    const std::string fault = scene.fault();
    EXPECT_NE(fault.find("at [5005"), std::string::npos) << fault;
    EXPECT_NE(fault.find("nothing rose below it"), std::string::npos) << fault;
    EXPECT_NE(fault.find("seed_m"), std::string::npos) << fault;
  }
  EXPECT_NE(SlideBeside(reservoir, false).fault().find("as water is"), std::string::npos);
  EXPECT_NE(SlideBeside(spoil).fault().find("several"), std::string::npos) << SlideBeside(spoil).fault();
  EXPECT_NE(SlideBeside(snow).fault().find("less than half"), std::string::npos);
}

TEST(candidates, two_slides_with_deposits_are_asked_for_unless_one_is_ten_times_the_other) {
  const auto second = [](double depth) {
    return [depth](double x, double y, double z) {
      return std::array{
          z, z - SlideBeside::bowl(x - 500, y - 60, 40, depth) + SlideBeside::bowl(x - 300, y - 60, 40, depth)};
    };
  };
  EXPECT_NE(SlideBeside(second(8)).fault().find("several"), std::string::npos);
  EXPECT_NEAR(SlideBeside(second(1)).prepared().total.volume, 23600, 2400);
}

TEST(candidates, a_point_or_an_outline_chooses_a_slide_whose_deposit_is_gone) {
  SlideBeside scene(reservoir, false);
  scene.options.source.seed = {SlideBeside::west + SlideBeside::scar_x, SlideBeside::south + SlideBeside::scar_y};
  scene.expect_slide();
  scene.options.source.seed.clear();
  scene.options.source.polygon = test::write_polygon(scene.scratch, "scar.csv",
                                                     "POLYGON((500440 5100130, 500570 5100130, 500570 5100260, "
                                                     "500440 5100260, 500440 5100130))");
  scene.expect_slide();
}

TEST(candidates, ignored_ground_is_neither_source_nor_deposit_nor_change_beside_the_slide) {
  SlideBeside scene(spoil);
  scene.options.difference.ignore = test::write_polygon(
      scene.scratch, "quarry.csv",
      "MULTIPOLYGON(((500350 5100265, 500490 5100265, 500490 5100400, 500350 5100400, 500350 5100265)), "
      "((500000 5100290, 500150 5100290, 500150 5100400, 500000 5100400, 500000 5100290)))");
  scene.expect_slide();
  const Prepared found = scene.prepared();
  EXPECT_EQ(std::ranges::count(found.domain.findings, "larger-lowering", &Finding::name), 0);
  EXPECT_LT(found.slide->outside.sure_fall + found.slide->outside.sure_rise, 100);
  EXPECT_EQ(inputs_of(scene.options).size(), 3u);
  SlideBeside other(nothing);
  other.options.difference.ignore = test::write_polygon(
      other.scratch, "afar.csv", "POLYGON((600350 5100265, 600490 5100265, 600490 5100400, 600350 5100265))");
  EXPECT_EQ(std::ranges::count(other.prepared().domain.findings, "ignore-covers-nothing", &Finding::name), 1);
}

}  // namespace
}  // namespace talus::preprocess
