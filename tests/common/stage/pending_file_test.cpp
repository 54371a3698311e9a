// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are there whole or not at all.
#include "common/stage/stage.hpp"

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;
using test::text_of;

TEST(PendingFile, shows_nothing_until_committed) {
  const Scratch scratch;
  {
    PendingFile pending(scratch / "map.tif");
    std::ofstream(pending.path()) << "half";
    EXPECT_TRUE(pending.path().filename().string().starts_with(".map.tif.")) << pending.path();
    EXPECT_TRUE(pending.path().filename().string().ends_with(".partial")) << pending.path();
    EXPECT_FALSE(std::filesystem::exists(scratch / "map.tif"));
  }
  EXPECT_EQ(scratch.files(), 0u);
}

TEST(PendingFile, keeps_the_old_file_when_the_new_one_is_given_up) {
  const Scratch scratch;
  scratch.write("map.tif", "old");
  {
    const PendingFile given_up(scratch / "map.tif");
    std::ofstream(given_up.path()) << "half";
    std::ofstream(given_up.path().string() + ".aux.xml") << "what GDAL leaves beside it";
  }
  EXPECT_EQ(text_of(scratch / "map.tif"), "old");
  EXPECT_EQ(scratch.files(), 1u);
  PendingFile pending(scratch / "map.tif");
  std::ofstream(pending.path()) << "new";
  pending.commit();
  EXPECT_EQ(text_of(scratch / "map.tif"), "new");
}

TEST(PendingFile, a_commit_without_a_file_is_a_fault) {
  const Scratch scratch;
  PendingFile pending(scratch / "map.tif");
  EXPECT_EQ(fault_of<DataError>([&] { pending.commit(); }),
            (scratch / "map.tif").string() +
                ": cannot be written (No such file or directory). Check the folder's permissions "
                "and free space, or write elsewhere with --out DIR");
}

TEST(WriteText, leaves_nothing_when_the_disk_fills_up) {
  const Scratch scratch;
  scratch.write("score.json", "old");
  std::string fault;
  {
    const test::SmallFiles limit(100000);
    fault = fault_of<DataError>([&] { write_text(scratch / "score.json", std::string(300000, 'x')); });
  }
  EXPECT_TRUE(fault.starts_with((scratch / "score.json").string() + ": cannot be written (File too large)")) << fault;
  EXPECT_EQ(text_of(scratch / "score.json"), "old");
  EXPECT_EQ(scratch.files(), 1u);
}

TEST(WriteText, names_the_reason_of_the_system) {
  const std::string fault = fault_of<DataError>([] { write_text("/no/such/folder/a.txt", "x"); });
  EXPECT_TRUE(fault.starts_with("/no/such/folder/a.txt: cannot be written (No such file or directory)")) << fault;
}

}  // namespace
}  // namespace talus
