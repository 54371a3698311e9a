// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/level_set.hpp"

#include <openvdb/openvdb.h>
#include <sys/wait.h>
#include <unistd.h>

#include <openvdb/io/File.h>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/domain/domain.hpp"
#include "common/domain/grids.hpp"
#include "common/stage/signals.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::holds;
using test::Scratch;

constexpr std::array<double, 3> one_metre{1, 1, 1};  // the largest facets

SolidBody ball(const std::string& name, double x, double y, double z, double radius) {
  return {name,
          {x - radius, y - radius, z - radius},
          {x + radius, y + radius, z + radius},
          [=](double px, double py, double pz) { return std::hypot(px - x, py - y, pz - z) - radius; }};
}

/// A body that no voxel of 1 m about the middle of its box lies in.
SolidBody dust() {
  SolidBody body = ball("dust", 0.26, 0.26, 0.26, 0.1);
  body.low = {0, 0, 0};
  body.high = {1, 1, 1};
  return body;
}

using LevelSet = test::InScratch;

TEST_F(LevelSet, surface_of_a_ball_far_from_the_origin) {
  write_level_sets(scratch / "ball.vdb", {ball("ball", 512345.3, 5432100.7, 1234.5, 10)}, 0.5);
  for (const double largest : {5.0, 0.3}) {  // with and without facets to be cut
    const BodySurface surface = read_level_set(scratch / "ball.vdb", "", {largest, largest, largest});
    EXPECT_NEAR(surface.volume, 4 * std::numbers::pi / 3 * 1000,
                0.01 * 4189);  // facets cut corners: (voxel / radius)^2
    double area = 0, radius_error = 0;
    for (const Facet& f : surface.facets) {
      const double out[3] = {f.centre[0] - 512345.3, f.centre[1] - 5432100.7, f.centre[2] - 1234.5};
      const double size = std::hypot(f.area[0], f.area[1], f.area[2]), distance = std::hypot(out[0], out[1], out[2]);
      EXPECT_GT(out[0] * f.area[0] + out[1] * f.area[1] + out[2] * f.area[2], 0.9 * distance * size)
          << "normals point outward";
      area += size;
      radius_error = std::max(radius_error, std::abs(distance - 10));
    }
    EXPECT_NEAR(area, 4 * std::numbers::pi * 100, 0.02 * 1257);
    EXPECT_LT(radius_error, 0.1);
  }
}

TEST_F(LevelSet, surface_of_a_body_in_memory_is_that_of_its_file) {
  const SolidBody body = ball("ball", 512345.3, 5432100.7, 1234.5, 4);
  write_level_sets(scratch / "ball.vdb", {body}, 0.5);
  const BodySurface file = read_level_set(scratch / "ball.vdb", "", {0.3, 0.4, 0.5});
  const BodySurface memory = surface_of({body, 0.5}, {0.3, 0.4, 0.5});
  test::expect_same(memory, file, &BodySurface::volume, &BodySurface::low);
  ASSERT_EQ(memory.facets.size(), file.facets.size());
  for (std::size_t f = 0; f < file.facets.size(); ++f) EXPECT_EQ(memory.facets[f].area, file.facets[f].area) << f;
  EXPECT_NE(data_fault([&] { surface_of({dust(), 1}, {1, 1, 1}); }), "");
}

TEST_F(LevelSet, several_bodies_are_told_apart_by_name_and_a_changed_byte_is_noticed_before_openvdb_sees_it) {
  write_level_sets(scratch / "two.vdb", {ball("small", 0, 0, 0, 3), ball("large", 20, 0, 0, 6)}, 0.5);
  EXPECT_NEAR(read_level_set(scratch / "two.vdb", "large", {9, 9, 9}).volume, 904.8, 18);
  EXPECT_TRUE(holds(data_fault([&] { read_level_set(scratch / "two.vdb", "", one_metre); }), {"holds 2 grids"}));
  EXPECT_TRUE(holds(data_fault([&] { read_level_set(scratch / "two.vdb", "medium", one_metre); }), {"large, small"}));
  write_level_sets(scratch / "ball.vdb", {ball("ball", 0, 0, 0, 3)}, 0.5);
  std::string changed = test::text_of(scratch / "ball.vdb");
  changed[changed.size() / 2] = static_cast<char>(changed[changed.size() / 2] ^ 1);
  const auto file = scratch.write("changed.vdb", changed);
  EXPECT_TRUE(holds(data_fault([&] { read_level_set(file, "", one_metre); }), {"is damaged (bytes have changed"}));
}

TEST_F(LevelSet, a_file_of_another_program_is_read_to_the_same_surface) {
  write_level_sets(scratch / "ball.vdb", {ball("ball", 512345.3, 5432100.7, 1234.5, 4)}, 0.5);
  const BodySurface ours = read_level_set(scratch / "ball.vdb", "", {0.3, 0.3, 0.3});
  const auto foreign = scratch.write("foreign.vdb", test::without_seal(scratch / "ball.vdb"));
  const BodySurface theirs = read_level_set(foreign, "ball", {0.3, 0.3, 0.3});
  test::expect_same(theirs, ours, &BodySurface::volume, &BodySurface::low, &BodySurface::high);
  ASSERT_EQ(theirs.facets.size(), ours.facets.size());
  test::expect_same(theirs.facets.back(), ours.facets.back(), &Facet::centre, &Facet::area);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers report crashes themselves
/// Reads a level set as a stage does: exit code 0, or 3 with the file on stderr.
[[noreturn]] void read_and_exit(const std::filesystem::path& file) {
  report_crashes("talus-test");
  ::alarm(60);  // a hang ends by a signal
  std::string said = "read " + file.string();
  int code = 0;
  try {
    read_level_set(file, "", one_metre);
  } catch (const DataError& error) {
    said = error.what();
    code = static_cast<int>(error.code());
  }
  std::fputs(said.c_str(), stderr);
  ::_exit(code);
}

TEST(LevelSetDeathTest, damaged_files_of_other_programs_end_in_an_error_or_a_surface) {
  const Scratch scratch;
  const auto write_ball = [&] {
    write_level_sets(scratch / "ball.vdb", {ball("ball", 0, 0, 0, 3)}, 0.5);
    ::_exit(0);
  };
  EXPECT_EXIT(write_ball(), testing::ExitedWithCode(0), "")
      << "here, OpenVDB would start threads before the forks below";
  const std::string bytes = test::without_seal(scratch / "ball.vdb");
  const auto result_or_error = [](int status) {
    return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 3);
  };
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto file = scratch.write("damaged.vdb", test::damaged(bytes, seed));
    EXPECT_EXIT(read_and_exit(file), result_or_error, "damaged.vdb") << "seed " << seed;
  }
}
#endif

/// What reading says of a level set that was changed after it was written.
std::string level_set_fault_after(const std::function<void(openvdb::FloatGrid&)>& change) {
  const Scratch scratch;
  const auto path = scratch / "ball.vdb";
  write_level_sets(path, {ball("ball", 0, 0, 0, 3)}, 0.5);
  openvdb::io::File file(path.string());
  file.open(false);
  const auto grids = file.getGrids();
  file.close();
  change(*openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front()));
  openvdb::io::File(path.string()).write(*grids);
  return fault_of<DataError>([&] { read_level_set(path, "", one_metre); });
}

TEST_F(LevelSet, numbers_that_cannot_be_are_refused) {
  EXPECT_EQ(level_set_fault_after([](openvdb::FloatGrid&) {}), "");
  const auto of_voxels = [](double size) {
    return level_set_fault_after(
        [&](openvdb::FloatGrid& grid) { grid.setTransform(openvdb::math::Transform::createLinearTransform(size)); });
  };
  EXPECT_TRUE(holds(of_voxels(1e8), {"its voxels have 1e+24 m3"}));
  EXPECT_TRUE(holds(of_voxels(1e5), {"is too large for this grid"}));
  EXPECT_TRUE(holds(level_set_fault_after([](openvdb::FloatGrid& grid) {
                      grid.tree().setValueOn({0, 0, 6}, std::numeric_limits<float>::quiet_NaN());
                    }),
                    {"at voxel 0 0 6 it holds nan"}));
}

TEST_F(LevelSet, refuses_what_is_none) {
  EXPECT_THROW(read_level_set(scratch / "none.vdb", "", one_metre), DataError);
  Domain domain;
  domain.grid = {4, 4, 0, 0, 1, ""};
  domain.layer_height = 1;
  domain.terrain = domain.before = domain.release_thickness = {domain.grid, std::vector<double>(16, 1.0)};
  write_domain(scratch / "domain.vdb", domain);
  EXPECT_TRUE(
      holds(data_fault([&] { read_level_set(scratch / "domain.vdb", "terrain", one_metre); }), {"is no level set"}));
  EXPECT_THROW(write_level_sets(scratch / "thin.vdb", {dust()}, 1), DataError);
  EXPECT_FALSE(std::filesystem::exists(scratch / "thin.vdb"));
}

openvdb::GridPtrVec small_grid() {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0);
  grid->setName("one");
  grid->tree().setValue({1, 2, 3}, 4.0F);
  return {grid};
}

// openvdb::io::File ends well here.
TEST(WriteGrids, what_is_written_is_read_again_and_a_write_that_fails_is_an_error) {
  const Scratch scratch;
  write_grids(scratch / "one.vdb", "one.vdb", small_grid());
  openvdb::io::File file((scratch / "one.vdb").string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("one"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->tree().getValue({1, 2, 3}), 4.0F);
  const std::string fault = fault_of<DataError>([] { write_grids("/dev/full", "walls.vdb", small_grid()); });
  EXPECT_TRUE(holds(fault, {"walls.vdb: cannot be written", "the disk is full"}));
}

}  // namespace
}  // namespace talus
