// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles, strips and halves of a mosaic are told from slides; no correction raises the spread.
#include "preprocess/survey/shifted_parts.hpp"

#include <functional>

#include "preprocess/survey/coregistration.hpp"
#include "tests/common/findings.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;
using Shape = std::function<double(double, double)>;  // of column and row, in cells from the south-west: height [m]

/// A change with the name that a failure tells.
struct Case {
  const char* name;
  Shape change;
};

constexpr int columns = 150, rows = 110;

double bowl(double x, double y, double a, double b, double depth) {
  const double q = x * x / (a * a) + y * y / (b * b);
  return q < 1 ? depth * (1 - q) : 0;
}
/// A slide down to the west: a scar and a deposit.
double slide(double c, double r) { return bowl(c - 100, r - 60, 14, 11, -9) + bowl(c - 50, r - 58, 20, 13, 6); }
bool within(double v, double from, double to) { return v >= from && v < to; }

const std::vector<Case> shifted{
    {"east lower", [](double c, double) { return c >= 94 ? -2.5 : 0; }},
    {"east higher, by little", [](double c, double) { return c >= 94 ? 0.9 : 0; }},
    {"half", [](double c, double) { return c >= columns / 2 ? -2.5 : 0; }},
    {"north higher", [](double, double r) { return r >= 80 ? 1.5 : 0; }},
    {"oblique", [](double c, double r) { return c + 0.6 * r >= 140 ? -2 : 0; }},
    {"steep oblique", [](double c, double r) { return 0.2 * c + r >= 90 ? -2 : 0; }},
    {"a part tilts", [](double c, double r) { return c >= 94 ? -1.5 - 0.02 * (c - 94) - 0.01 * r : 0; }},
    {"tile in a corner", [](double c, double r) { return c >= 100 && r >= 70 ? -1.8 : 0; }},
    {"tile in the middle", [](double c, double r) { return within(c, 40, 80) && within(r, 20, 50) ? -1.8 : 0; }},
    {"tiles of four heights",
     [](double c, double r) { return (c >= 70 ? 1.2 : 0) + (r >= 50 ? -2.2 : 0) + (c >= 70 && r >= 50 ? 3.1 : 0); }},
    {"chequered",
     [](double c, double r) { return (static_cast<int>(c / 50) + static_cast<int>(r / 55)) % 2 == 0 ? 1.4 : 0; }},
    {"one stripe", [](double c, double) { return within(c, 30, 42) ? 1.6 : 0; }},
    {"stripes", [](double, double r) { return static_cast<int>(r / 22) % 2 == 0 ? 1.3 : 0; }},
    {"stripes of several heights", [](double c, double) { return 0.9 * ((static_cast<int>(c / 30) * 2) % 5); }},
    {"oblique stripe", [](double c, double r) { return within(c - r, 10, 40) ? -2 : 0; }},
};

const std::vector<Case> genuine{
    {"nothing", [](double, double) { return 0.0; }},
    {"round and deep", [](double c, double r) { return bowl(c - 75, r - 55, 45, 45, -60); }},
    {"long and narrow", [](double c, double r) { return bowl(c - 75, r - 55, 60, 12, -7); }},
    {"cut by the rim", [](double c, double r) { return bowl(c - 150, r - 55, 40, 25, -12); }},
    {"no deposit", [](double c, double r) { return bowl(c - 60, r - 55, 30, 14, -5); }},
    {"a channel with straight sides",
     [](double c, double r) { return within(c, 20, 110) ? -std::max(0.0, 4 - 0.5 * std::abs(r - 55)) : 0; }},
    {"a straight wedge",
     [](double c, double r) {
       return within(c, 60, 110) && within(r, 30, 80) ? -8 * (c - 60) / 50 : 0;  // a plane slide between joints
     }},
    {"a block and its heap",
     [](double c, double r) {
       return (within(c, 90, 120) && within(r, 40, 70) ? -6.0 : 0) + (within(c, 20, 60) && within(r, 38, 74) ? 4.0 : 0);
     }},
    {"a tongue of one thickness",
     [](double c, double r) {
       const double half = 9 + 4 * std::sin(c / 9) + 2 * std::sin(c / 3.1);
       return (within(c, 20, 90) && std::abs(r - 55) < half ? 2.0 : 0) + bowl(c - 115, r - 55, 20, 20, -6);
     }},
    {"whole map lower", [](double, double) { return -3.0; }},
    {"tilted", [](double c, double r) { return 0.02 * c - 0.01 * r; }},
};

/// Two surveys of hills, with noise of each and a change of the later one.
std::vector<Patch> surveys(test::Seeded& random, double noise, const Shape& change, bool with_slide = true) {
  const MapGrid grid = grid_of(columns, rows, 10);
  const test::Hills hills(grid, random);
  std::normal_distribution<double> error(0, 1);
  Elevation before, after;
  before.file = "before.tif";
  after.file = "after.tif";
  before.raster = raster_of(grid, [&](double x, double y) { return hills(x, y) + noise * error(random); });
  after.raster = raster_of(grid, [&](double x, double y) {
    const double c = (x - grid.west) / grid.cell, r = (y - grid.south) / grid.cell;
    return hills(x, y) + noise * error(random) + change(c, r) + (with_slide ? slide(c, r) : 0);
  });
  auto patches = patches_of(before, after, grid);
  find_stable(patches, {});
  return patches;
}

TEST(shifted_parts, of_steps_tiles_and_stripes_are_found_beside_a_slide) {
  test::Seeded random;
  for (const double noise : {0.0, 0.05, 0.15})
    for (const Case& one : shifted)
      EXPECT_FALSE(shifted_parts(surveys(random, noise, one.change).front(), {}).empty()) << one.name << " " << noise;
}

TEST(shifted_parts, are_not_found_in_slides) {
  test::Seeded random;
  for (const double noise : {0.0, 0.05, 0.15, 0.5})
    for (const Case& one : genuine)
      for (const bool with_slide : {false, true})
        EXPECT_TRUE(shifted_parts(surveys(random, noise, one.change, with_slide).front(), {}).empty())
            << one.name << " " << noise << " " << with_slide;
}

TEST(shifted_parts, are_refused_with_place_and_step_unless_accepted) {
  test::Seeded random;
  const auto patches = surveys(random, 0.1, shifted.front().change);
  const auto judge = [&] { judge_shifted_parts(patches, {}, "after.tif"); };
  EXPECT_TRUE(test::holds(test::fault_of<DataError>(judge), {"after.tif: less the surface before, 6", "lie 2.",
                                                             "m lower", "accept = [\"shifted-part\"]"}));
  EXPECT_EQ(test::findings_of(judge, {"shifted-part"}).size(), 1u);
}

TEST(coregistration, never_raises_the_spread_on_stable_ground) {
  test::Seeded random;
  for (const auto* cases : {&shifted, &genuine})
    for (const Case& one : *cases) {
      auto patches = surveys(random, 0.15, one.change);
      const Coregistration fit = coregister(patches, true, "after.tif");
      if (!fit.known) continue;
      EXPECT_LE(fit.aligned.nmad, fit.unaligned.nmad) << one.name;
      EXPECT_LE(fit.aligned.median_absolute, fit.unaligned.median_absolute) << one.name;
    }
}

}  // namespace
}  // namespace talus::preprocess
