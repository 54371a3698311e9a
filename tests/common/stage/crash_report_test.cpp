// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A crash while a file is read names the file.
#include "common/stage/crash_report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "common/error.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers report crashes themselves

namespace talus {
namespace {

const testing::ExitedWithCode ends_as_data_error(static_cast<int>(ExitCode::data));

TEST(CrashReportDeathTest, names_the_file_that_is_read_and_the_remedy) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading outer("/a/run.h5", "Run it again");
        const WhileReading reading("/a/wall.vdb", "Write it again");
        ::raise(SIGSEGV);
      },
      ends_as_data_error,
      "talus-test: crashed while reading /a/wall.vdb .signal 11.: the file is damaged. Write it again\n");
}

TEST(CrashReportDeathTest, names_the_outer_file_once_the_inner_one_is_read) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading outer("/a/run.h5", "Run it again");
        { const WhileReading reading("/a/wall.vdb", "Write it again"); }
        std::abort();
      },
      ends_as_data_error, "talus-test: crashed while reading /a/run.h5 .signal 6.: the file is damaged. Run it again");
}

TEST(CrashReportDeathTest, worker_threads_of_a_library_count_as_well) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading reading("/a/wall.vdb", "Write it again");
        std::thread([] { ::raise(SIGFPE); }).join();
      },
      ends_as_data_error, "crashed while reading /a/wall.vdb .signal 8.");
}

TEST(CrashReportDeathTest, has_room_where_the_stack_has_none) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading reading("/a/wall.vdb", "Write it again");
        const struct Recursion {
          int into(volatile char* above) const {
            volatile char room[4096];
            room[0] = above[0];
            return room[0] == 0 ? into(room) + 1 : 0;  // a compiler that sees no end would refuse it
          }
        } without_end;
        volatile char first = 0;
        without_end.into(&first);
      },
      ends_as_data_error, "crashed while reading /a/wall.vdb .signal 11.");
}

TEST(CrashReportDeathTest, other_crashes_end_as_they_do_without_it) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        { const WhileReading reading("/a/wall.vdb", "Write it again"); }
        ::raise(SIGSEGV);
      },
      testing::KilledBySignal(SIGSEGV), "");
}

}  // namespace
}  // namespace talus

#endif
