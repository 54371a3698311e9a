// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What this process may take of the machine.
#include "common/stage/machine.hpp"

#include <sched.h>
#include <cmath>

#include "common/gis/point_layer.hpp"
#include "common/stage/in_threads.hpp"
#include "common/stage/input_file.hpp"
#include "tests/common/scratch.hpp"

#include <sys/stat.h>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

namespace talus {
namespace {

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

TEST(Machine, takes_the_number_of_threads_that_is_given) {
  set_thread_limit(3);
  EXPECT_EQ(thread_limit(), 3);
  set_thread_limit(0);
  EXPECT_EQ(thread_limit(), usable_threads());
}

TEST(Machine, refuses_what_no_memory_holds_with_both_numbers) {
  EXPECT_GT(usable_memory(), 1e6);
  EXPECT_NO_THROW(require_memory(1e6, "a grid", ""));
  const std::string fault = test::fault_of<DataError>([] { require_memory(1e19, "a grid", "Take less"); });
  EXPECT_TRUE(fault.starts_with("a grid (1e+07 TB are needed, this process may have ")) << fault;
  EXPECT_TRUE(fault.ends_with("). Take less")) << fault;
}

TEST(Input, refuses_what_cannot_be_sought_in) {
  const test::Scratch scratch;
  const auto pipe = scratch / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { require_plain(pipe); }),
                          {"pipe: cannot be read (it is a pipe). Give a "}));
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([] { require_plain("/dev/zero"); }), {"it is a device"}));
  EXPECT_NO_THROW(require_plain(scratch / "missing"));
  EXPECT_NO_THROW(require_plain(scratch.folder()));
  EXPECT_NO_THROW(require_plain(scratch.write("plain", "x")));
}

TEST(Machine, tells_what_the_system_says_of_its_memory_by_whole_names) {
  const double all = memory_of_machine("MemTotal"), free = memory_of_machine("MemAvailable");
  EXPECT_GT(free, 0);
  EXPECT_LT(free, all);
  EXPECT_TRUE(std::isinf(memory_of_machine("Mem")));
}

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

/// The limit of threads while a test runs.
struct Limit {
  explicit Limit(int threads) { set_thread_limit(threads); }
  ~Limit() { set_thread_limit(0); }
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

}  // namespace
}  // namespace talus
