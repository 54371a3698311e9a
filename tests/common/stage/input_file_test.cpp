// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an input must be to be opened, and to have been read.
#include "common/stage/input_file.hpp"

#include "common/gis/point_layer.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

// A plain file of which the first byte already cannot be read: EIO, as from a disk that fails.
const std::filesystem::path failing = "/proc/self/mem";

TEST(InputFile, that_fails_under_its_reader_is_no_shorter_file) {
  std::ifstream stream(failing);
  for (std::string line; std::getline(stream, line);) FAIL() << "a line was read";
  const std::string fault = test::fault_of<DataError>([&] { require_read(stream, failing); });
  EXPECT_EQ(fault.find("/proc/self/mem: cannot be read to its end (Input/output error)"), 0u) << fault;
  const test::Scratch scratch;
  std::ifstream whole(scratch.write("two.txt", "one\ntwo\n"));
  for (std::string line; std::getline(whole, line);) EXPECT_FALSE(line.empty());
  EXPECT_NO_THROW(require_read(whole, "two.txt")) << "its end is no failure";
}

TEST(InputFile, that_fails_is_refused_before_GDAL_looks_for_the_end_of_its_cells) {
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([] { glance_at_raster(failing); }), {"cannot be read"}));
}

TEST(InputFile, text_counts_as_missing_only_where_it_is_not_there) {
  const test::Scratch scratch;
  const std::string long_text(200'000, 'x');
  EXPECT_EQ(text_if_there(scratch.write("long.txt", long_text)), long_text);
  EXPECT_EQ(text_if_there(scratch.write("empty.txt", "")), "");
  EXPECT_EQ(text_if_there(scratch / "none.txt"), std::nullopt);
  EXPECT_TRUE(
      test::holds(test::fault_of<DataError>([] { text_if_there(failing); }), {"cannot be read (Input/output error)"}));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { text_if_there(scratch.folder()); }), {"it is a folder"}));
}

}  // namespace
}  // namespace talus
