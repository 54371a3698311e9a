// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What this process may take of the machine, the files it reads and the folder it writes to.
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <sched.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/gis/features.hpp"
#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::begins;
using test::fault_of;
using test::holds;
using test::names_in;
using test::Scratch;
using test::text_of;

TEST(Machine, a_process_grows_as_old_as_time_passes) {
  const double young = age_of_process();
  EXPECT_GE(young, 0);
  EXPECT_LT(young, 3600);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GT(age_of_process() - young, 0.09);
}

TEST(Machine, as_many_threads_as_the_affinity_mask_has_processors) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  std::size_t first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const int threads = usable_threads();
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(threads, 1);
  EXPECT_LE(usable_threads(), CPU_COUNT(&before));
}

TEST(Machine, takes_the_number_of_threads_refuses_what_no_memory_holds_and_tells_what_the_system_says) {
  context().threads = 3;
  EXPECT_EQ(thread_limit(), 3);
  context().threads = 0;
  EXPECT_EQ(thread_limit(), usable_threads());
  EXPECT_GT(usable_memory(), 1e6);
  EXPECT_NO_THROW(require_memory(1e6, "a grid", ""));
  const std::string fault = test::fault_of<DataError>([] { require_memory(1e19, "a grid", "Take less"); });
  EXPECT_TRUE(begins(fault, "a grid (1e+07 TB are needed, this process may have "));
  EXPECT_TRUE(fault.ends_with("). Take less")) << fault;
  const double all = memory_of_machine("MemTotal"), free = memory_of_machine("MemAvailable");
  EXPECT_GT(free, 0);
  EXPECT_LT(free, all);
  EXPECT_TRUE(std::isinf(memory_of_machine("Mem")));
}

TEST(Input, refuses_what_cannot_be_sought_in) {
  const test::Scratch scratch;
  const auto pipe = scratch / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(
      holds(test::fault_of<DataError>([&] { require_plain(pipe); }), {"pipe: cannot be read (it is a pipe). Give a "}));
  EXPECT_TRUE(holds(test::fault_of<DataError>([] { require_plain("/dev/zero"); }), {"it is a device"}));
  EXPECT_NO_THROW(require_plain(scratch / "missing"));
  EXPECT_NO_THROW(require_plain(scratch.folder()));
  EXPECT_NO_THROW(require_plain(scratch.write("plain", "x")));
}

// A plain file of which the first byte already cannot be read: EIO, as from a disk that fails.
const std::filesystem::path failing = "/proc/self/mem";

TEST(InputFile, that_fails_under_its_reader_is_no_shorter_file_and_refused_before_GDAL_looks_for_its_end) {
  std::ifstream stream(failing);
  for (std::string line; std::getline(stream, line);) FAIL() << "a line was read";
  EXPECT_TRUE(begins(test::fault_of<DataError>([&] { require_read(stream, failing); }),
                     "/proc/self/mem: cannot be read to its end (Input/output error)"));
  const test::Scratch scratch;
  std::ifstream whole(scratch.write("two.txt", "one\ntwo\n"));
  for (std::string line; std::getline(whole, line);) EXPECT_FALSE(line.empty());
  EXPECT_NO_THROW(require_read(whole, "two.txt")) << "its end is no failure";
  EXPECT_TRUE(holds(test::fault_of<DataError>([] { glance_at_raster(failing); }), {"cannot be read"}));
}

TEST(InputFile, text_counts_as_missing_only_where_it_is_not_there) {
  const test::Scratch scratch;
  const std::string long_text(200'000, 'x');
  EXPECT_EQ(text_if_there(scratch.write("long.txt", long_text)), long_text);
  EXPECT_EQ(text_if_there(scratch.write("empty.txt", "")), "");
  EXPECT_EQ(text_if_there(scratch / "none.txt"), std::nullopt);
  EXPECT_TRUE(
      holds(test::fault_of<DataError>([] { text_if_there(failing); }), {"cannot be read (Input/output error)"}));
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { text_if_there(scratch.folder()); }), {"it is a folder"}));
}

/// The limit of threads while a test runs.
struct Limit {
  explicit Limit(int threads) { context().threads = threads; }
  ~Limit() { context().threads = 0; }
};

TEST(InThreads, every_place_is_visited_once) {
  const Limit limit(8);
  std::vector<std::atomic<int>> visits(1000);
  in_threads(visits.size(), "visiting", [&](std::size_t place) { ++visits[place]; });
  for (const auto& count : visits) EXPECT_EQ(count, 1);
}

TEST(InThreads, no_more_threads_are_taken_than_the_process_may_have_nor_than_were_asked_for) {
  for (const auto& [threads, most] : {std::pair{3, 16}, std::pair{16, 3}, std::pair{1, 16}}) {
    const Limit limit(threads);
    std::set<std::thread::id> seen;
    std::mutex mutex;
    const auto note = [&](std::size_t) {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    };
    in_threads(500, "counting", note, static_cast<std::size_t>(most));
    EXPECT_LE(seen.size(), static_cast<std::size_t>(std::min(threads, most)));
    EXPECT_GE(seen.size(), 1U);
  }
}

TEST(InThreads, the_fault_of_the_lowest_place_is_thrown_and_nothing_is_begun_after_it) {
  const Limit limit(4);
  std::atomic<int> begun{0};
  const auto work = [&](std::size_t place) {
    ++begun;
    if (place >= 5) throw std::runtime_error(std::to_string(place));
  };
  try {
    in_threads(100'000, "failing", work);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), std::string("5"));  // places are taken in order: who takes 6 comes after who took 5
  }
  EXPECT_LE(begun, 9);  // each thread may have begun one more
}

TEST(InThreads, nothing_to_do_is_done_at_once) {
  in_threads(0, "idling", [](std::size_t) { FAIL(); });
}

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
  EXPECT_TRUE(begins(
      text, scratch.folder().string() + ": in use by talus-first (process " + std::to_string(::getpid()) + " on "));
  EXPECT_TRUE(holds(text, {" UTC)"}));
  EXPECT_TRUE(text.ends_with("Wait for it or end it, or write elsewhere with --out DIR")) << text;
  EXPECT_TRUE(holds_output_lock());
}

TEST(OutputLock, another_folder_is_free) {
  const Scratch first, second;
  const OutputLock lock(first.folder(), "talus-first");
  EXPECT_EQ(asked_elsewhere(second.folder()), "");
}

TEST(OutputLock, leaves_nothing_is_free_again_and_says_of_a_full_disk_before_long_work_begins) {
  const Scratch scratch;
  { const OutputLock lock(scratch.folder(), "talus-first"); }
  EXPECT_EQ(scratch.files(), 0u);
  EXPECT_FALSE(holds_output_lock());
  EXPECT_EQ(asked_elsewhere(scratch.folder()), "");
  const test::SmallFiles limit(0);
  EXPECT_EQ(fault_of<DataError>([&] { const OutputLock lock(scratch.folder(), "talus-first"); }),
            scratch.folder().string() +
                ": the output folder cannot be written to (File too large). Name another one with --out DIR");
  EXPECT_EQ(scratch.files(), 0u);
}

TEST(OutputLock, the_file_of_a_killed_process_is_no_lock) {
  const Scratch scratch;
  const pid_t child = ::fork();
  if (child == 0) {
    new OutputLock(scratch.folder(), "talus-killed");
    ::_exit(0);  // no destructor: the file stays
  }
  ::waitpid(child, nullptr, 0);
  ASSERT_TRUE(holds(text_of(scratch / ".talus.lock"), {"talus-killed"}));
  const OutputLock lock(scratch.folder(), "talus-next");
  EXPECT_TRUE(holds(text_of(scratch / ".talus.lock"), {"talus-next (process"}));
}

/// What stands in the way of a result called `name`, one of each kind; the victim is what a link leads to.
void put_in_the_way(const std::string& kind, const std::filesystem::path& name, const std::filesystem::path& victim) {
  if (kind == "it is a link") std::filesystem::create_symlink(victim, name);
  if (kind == "it is a folder") std::filesystem::create_directory(name);
  if (kind == "it is a pipe") {
    ASSERT_EQ(mkfifo(name.c_str(), 0600), 0);
  }
  if (kind == "it is a file of several names") std::filesystem::create_hard_link(victim, name);
}

TEST(OutputLock, follows_nothing_that_stands_under_its_name) {
  const Scratch elsewhere;
  const auto victim = elsewhere.write("victim", "x");
  for (const char* kind : {"it is a link", "it is a folder", "it is a pipe", "it is a file of several names"}) {
    const Scratch scratch;
    put_in_the_way(kind, scratch / ".talus.lock", victim);
    EXPECT_TRUE(holds(fault_of<DataError>([&] { const OutputLock lock(scratch.folder(), "talus-first"); }),
                      {".talus.lock: cannot be written (", kind, "Remove it, or write elsewhere with --out DIR"}));
    EXPECT_EQ(text_of(victim), "x") << kind;
  }
  const Scratch scratch;
  put_in_the_way("it is a link", scratch / ".talus.lock", elsewhere / "missing");
  EXPECT_NE(fault_of<DataError>([&] { const OutputLock lock(scratch.folder(), "talus-first"); }), "");
  EXPECT_FALSE(std::filesystem::exists(elsewhere / "missing"));
}

TEST(PendingFile, takes_the_name_of_a_plain_file_alone) {
  const Scratch scratch;
  const auto victim = scratch.write("victim", "x");
  for (const char* kind : {"it is a link", "it is a folder", "it is a pipe"}) {
    const auto name = scratch / ("map" + std::string(kind));
    put_in_the_way(kind, name, victim);
    EXPECT_TRUE(holds(fault_of<DataError>([&] { write_text(name, "y"); }), {name.c_str(), kind}));
  }
  EXPECT_EQ(text_of(victim), "x");
  write_text(victim, "y");
  EXPECT_EQ(text_of(victim), "y");
}

TEST(OutputFolder, may_be_a_link_and_what_lies_in_it_may_not) {
  const Scratch scratch, elsewhere;
  elsewhere.write("old", "x");
  std::filesystem::create_directory(scratch / "real");
  std::filesystem::create_directory_symlink(scratch / "real", scratch / "out");
  const OutputLock lock(scratch / "out", "talus-first");
  EXPECT_NO_THROW(make_folder(scratch / "out" / "maps" / "more"));
  EXPECT_NO_THROW(write_text(scratch / "out" / "maps" / "a.tif", "y"));
  std::filesystem::create_directory_symlink(elsewhere.folder(), scratch / "out" / "survey");
  for (const auto& path : {scratch / "out" / "survey", scratch / "out" / "survey" / "deep"})
    EXPECT_TRUE(
        holds(fault_of<DataError>([&] { make_folder(path); }), {"out/survey: cannot be written (it is a link"}));
  EXPECT_NE(fault_of<DataError>([&] { write_text(scratch / "out" / "survey" / "new", "y"); }), "");
  EXPECT_NE(fault_of<DataError>([&] { remove_for_good(scratch / "out" / "survey" / "old"); }), "");
  EXPECT_EQ(names_in(elsewhere.folder()), std::vector<std::string>{"old"});
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

TEST(PendingFile, shows_nothing_until_committed_and_a_commit_without_a_file_is_a_fault) {
  const Scratch scratch;
  {
    PendingFile pending(scratch / "map.tif");
    std::ofstream(pending.path()) << "half";
    EXPECT_TRUE(pending.path().filename().string().starts_with(".map.tif.")) << pending.path();
    EXPECT_TRUE(pending.path().filename().string().ends_with(".partial")) << pending.path();
    EXPECT_FALSE(std::filesystem::exists(scratch / "map.tif"));
  }
  EXPECT_EQ(scratch.files(), 0u);
  PendingFile none(scratch / "none.tif");
  EXPECT_EQ(fault_of<DataError>([&] { none.commit(); }),
            (scratch / "none.tif").string() +
                ": cannot be written (No such file or directory). Check the folder's permissions "
                "and free space, or write elsewhere with --out DIR");
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

TEST(WriteText, leaves_nothing_when_the_disk_fills_up) {
  const Scratch scratch;
  scratch.write("score.json", "old");
  std::string fault;
  {
    const test::SmallFiles limit(100000);
    fault = fault_of<DataError>([&] { write_text(scratch / "score.json", std::string(300000, 'x')); });
  }
  EXPECT_TRUE(begins(fault, (scratch / "score.json").string() +
                                ": cannot be written (it is longer than this process may write: File too large)"));
  EXPECT_EQ(text_of(scratch / "score.json"), "old");
  EXPECT_EQ(scratch.files(), 1u);
}

TEST(WriteText, names_the_reason_of_the_system) {
  EXPECT_TRUE(begins(fault_of<DataError>([] { write_text("/no/such/folder/a.txt", "x"); }),
                     "/no/such/folder/a.txt: cannot be written (No such file or directory)"));
}

}  // namespace
}  // namespace talus
