// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes in a file, read back by OpenVDB itself.
#include "common/domain/volume_file.hpp"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <stdexcept>

#include "common/error.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

VolumeFile some_volume() {
  return {.time = 2.5,
          .run_id = "abc",
          .crs = "EPSG:32632",
          .origin = {600000, 5100000, 850},
          .side = 2,
          .voxels = {{0, 0, 0}, {5, -1, 300}},
          .density = {2000, 12.5F},
          .velocity = {{1, 2, 3}, {0, 0, -7}}};
}

TEST(VolumeFile, comes_back_sparse_with_its_place) {
  const test::Scratch scratch;
  write_volume_file(scratch / "a.vdb", some_volume());
  openvdb::io::File file((scratch / "a.vdb").string());
  file.open();
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  const auto velocity = openvdb::gridPtrCast<openvdb::Vec3SGrid>(file.readGrid("velocity"));
  EXPECT_EQ(density->activeVoxelCount(), 2U);
  EXPECT_EQ(velocity->activeVoxelCount(), 2U);
  EXPECT_EQ(density->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(density->background(), 0);
  EXPECT_EQ(density->tree().getValue({5, -1, 300}), 12.5F);
  EXPECT_EQ(velocity->tree().getValue({5, -1, 300}), openvdb::Vec3s(0, 0, -7));
  EXPECT_EQ(velocity->tree().getValue({1, 1, 1}), openvdb::Vec3s(0));
  EXPECT_EQ(density->voxelSize(), openvdb::Vec3d(2));
  EXPECT_EQ(density->indexToWorld(openvdb::Vec3d(0)), openvdb::Vec3d(1));  // the centre of the first voxel
  EXPECT_EQ(density->metaValue<double>("origin_y_m"), 5100000);
  EXPECT_EQ(density->metaValue<double>("time_s"), 2.5);
  EXPECT_EQ(velocity->metaValue<std::string>("crs"), "EPSG:32632");
  EXPECT_EQ(density->metaValue<std::string>("unit"), "kg m-3");
}

TEST(VolumeFile, of_nothing_is_a_file_too) {
  const test::Scratch scratch;
  write_volume_file(scratch / "a.vdb", {});
  openvdb::io::File file((scratch / "a.vdb").string());
  file.open();
  EXPECT_TRUE(file.readGrid("density")->empty());
}

TEST(VolumeFile, lists_of_different_lengths_are_a_bug) {
  const test::Scratch scratch;
  VolumeFile volume = some_volume();
  volume.density.pop_back();
  EXPECT_THROW(write_volume_file(scratch / "a.vdb", volume), std::logic_error);
}

TEST(VolumeFile, a_full_disk_leaves_nothing_behind) {
  const test::Scratch scratch;
  const test::SmallFiles small(100);
  EXPECT_THROW(write_volume_file(scratch / "a.vdb", some_volume()), DataError);
  EXPECT_EQ(scratch.files(), 0U);
}

}  // namespace
}  // namespace talus
