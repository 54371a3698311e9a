// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/write_grids.hpp"

#include <openvdb/io/File.h>

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::Scratch;

openvdb::GridPtrVec small_grid() {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0);
  grid->setName("one");
  grid->tree().setValue({1, 2, 3}, 4.0F);
  return {grid};
}

// openvdb::io::File ends well here.
TEST(WriteGrids, a_write_that_fails_is_an_error) {
  try {
    write_grids("/dev/full", "walls.vdb", small_grid());
    FAIL() << "nothing was said of a disk that takes no byte";
  } catch (const DataError& error) {
    EXPECT_TRUE(test::holds(error.what(), {"walls.vdb: cannot be written", "the disk is full"}));
  }
}

TEST(WriteGrids, what_is_written_is_read_again) {
  const Scratch scratch;
  write_grids(scratch / "one.vdb", "one.vdb", small_grid());
  openvdb::io::File file((scratch / "one.vdb").string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("one"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->tree().getValue({1, 2, 3}), 4.0F);
}

}  // namespace
}  // namespace talus
