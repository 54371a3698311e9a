// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/output_lock.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::names_in;
using test::Scratch;
using test::text_of;

/// What another process says that asks for the lock of `folder`; "" where it gets it.
std::string asked_elsewhere(const std::filesystem::path& folder) {
  int ends[2] = {};
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string text = fault_of<DataError>([&] { const OutputLock lock(folder, "talus-second"); });
    if (::write(ends[1], text.data(), text.size()) < 0) ::_exit(1);
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string text;
  char part[512];
  for (ssize_t n = 0; (n = ::read(ends[0], part, sizeof part)) > 0;) text.append(part, static_cast<std::size_t>(n));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return text;
}

TEST(OutputLock, a_second_process_is_refused_by_the_name_of_the_first) {
  const Scratch scratch;
  const OutputLock lock(scratch.folder(), "talus-first");
  const std::string text = asked_elsewhere(scratch.folder());
  EXPECT_TRUE(text.starts_with(scratch.folder().string() + ": in use by talus-first (process " +
                               std::to_string(::getpid()) + " on "))
      << text;
  EXPECT_TRUE(test::holds(text, {" UTC)"}));
  EXPECT_TRUE(text.ends_with("Wait for it or end it, or write elsewhere with --out DIR")) << text;
  EXPECT_TRUE(holds_output_lock());
}

TEST(OutputLock, another_folder_is_free) {
  const Scratch first, second;
  const OutputLock lock(first.folder(), "talus-first");
  EXPECT_EQ(asked_elsewhere(second.folder()), "");
}

TEST(OutputLock, leaves_nothing_and_is_free_again) {
  const Scratch scratch;
  { const OutputLock lock(scratch.folder(), "talus-first"); }
  EXPECT_EQ(scratch.files(), 0u);
  EXPECT_FALSE(holds_output_lock());
  EXPECT_EQ(asked_elsewhere(scratch.folder()), "");
}

TEST(OutputLock, the_file_of_a_killed_process_is_no_lock) {
  const Scratch scratch;
  const pid_t child = ::fork();
  if (child == 0) {
    new OutputLock(scratch.folder(), "talus-killed");
    ::_exit(0);  // no destructor: the file stays
  }
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(test::holds(text_of(scratch / ".talus.lock"), {"talus-killed"}));
  const OutputLock lock(scratch.folder(), "talus-next");
  EXPECT_TRUE(test::holds(text_of(scratch / ".talus.lock"), {"talus-next (process"}));
}

TEST(OutputLock, a_full_disk_is_said_before_long_work_begins) {
  const Scratch scratch;
  const test::SmallFiles limit(0);
  EXPECT_EQ(fault_of<DataError>([&] { const OutputLock lock(scratch.folder(), "talus-first"); }),
            scratch.folder().string() +
                ": the output folder cannot be written to (File too large). Name another one with --out DIR");
  EXPECT_EQ(scratch.files(), 0u);
}

TEST(PendingFile, sweeps_what_a_killed_process_left_where_the_folder_is_its_own) {
  const Scratch scratch;
  scratch.write(".map.tif.77-0badcafe.partial", "half");
  scratch.write(".map.tif.77-0badcafe.partial.ovr.tmp", "of GDAL");
  scratch.write(".map.tifs.77-0badcafe.partial", "of another file");
  { const PendingFile pending(scratch / "map.tif"); }
  EXPECT_EQ(names_in(scratch.folder()).size(), 3u);  // another process may be at work there
  const OutputLock lock(scratch.folder(), "talus-first");
  const PendingFile pending(scratch / "map.tif");
  EXPECT_EQ(names_in(scratch.folder()), (std::vector<std::string>{".map.tifs.77-0badcafe.partial", ".talus.lock"}));
}

TEST(PendingFile, sweeps_under_each_lock_what_was_left_before_it) {
  const Scratch scratch;
  for (const char* left : {".map.tif.77-0badcafe.partial", ".map.tif.78-0badcafe.partial"}) {
    scratch.write(left, "half");
    const OutputLock lock(scratch.folder(), "talus-first");
    { const PendingFile pending(scratch / "other.tif"); }
    EXPECT_EQ(names_in(scratch.folder()), (std::vector<std::string>{left, ".talus.lock"}));
    { const PendingFile pending(scratch / "map.tif"); }
    EXPECT_EQ(names_in(scratch.folder()), std::vector<std::string>{".talus.lock"});
  }
}

}  // namespace
}  // namespace talus
