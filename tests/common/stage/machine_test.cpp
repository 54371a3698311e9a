// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What this process may take of the machine.
#include "common/stage/machine.hpp"

#include <sched.h>
#include <cmath>

#include "common/stage/input_file.hpp"
#include "tests/common/scratch.hpp"

#include <sys/stat.h>

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

}  // namespace
}  // namespace talus
