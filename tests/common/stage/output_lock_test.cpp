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
