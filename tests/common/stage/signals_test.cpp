// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The end of processes by signals, each in a process of its own: what it wrote, its exit code, what it left.
#include <atomic>
#include <chrono>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "common/stage/files.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using namespace std::chrono_literals;
using test::Scratch;
using test::text_of;

/// The exit code of a process that watches for signals with a short grace, sends itself SIGTERM, and does `then`.
int exit_code_of(const Scratch& scratch, const std::function<void()>& then) {
  const std::string log = (scratch / "log").string();
  const pid_t child = ::fork();
  if (child == 0) {
    if (std::freopen(log.c_str(), "w", stderr) == nullptr) ::_exit(97);
    watch_for_interrupts("talus-sample", 0.05);
    then();
    ::_exit(98);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// What a library does that cannot be asked to stop; the test's time limit ends it where nothing else does.
void work_on_for_ever() {
  for (;;) ::usleep(1000);
}

using Interrupt = test::InScratch;

TEST_F(Interrupt, ends_a_process_that_a_library_keeps_busy) {
  const int code = exit_code_of(scratch, [&] {
    const OutputLock lock(scratch.folder(), "talus-sample");
    const PendingFile pending(scratch / "map.tif");
    std::ofstream(pending.path()) << "half";
    write_text(scratch / "whole.txt", "whole");
    ::raise(SIGTERM);
    work_on_for_ever();
  });
  EXPECT_EQ(code, 130);
  EXPECT_EQ(test::names_in(scratch.folder()), (std::vector<std::string>{"log", "whole.txt"}));
  EXPECT_EQ(text_of(scratch / "log"),
            "\ntalus-sample: ended in the middle of its work (interrupted). What carries a final name is whole; run "
            "the stage again\n");
}

TEST_F(Interrupt, leaves_time_to_whoever_has_something_to_save) {
  const int code = exit_code_of(scratch, [&] {
    const OwnEnd saving("the state is saved first");
    ::raise(SIGTERM);
    const auto begun = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begun < 200ms) ::usleep(1000);  // four times the grace
    write_text(scratch / "state", "saved");
    ::_exit(interrupted() ? 5 : 6);
  });
  EXPECT_EQ(code, 5);
  EXPECT_EQ(text_of(scratch / "state"), "saved");
  EXPECT_EQ(text_of(scratch / "log"),
            "\ntalus-sample: interrupted; the state is saved first (a second Ctrl-C ends it at once)\n");
}

TEST_F(Interrupt, counts_the_grace_once_nothing_is_left_to_save) {
  EXPECT_EQ(exit_code_of(scratch,
                         [] {
                           {
                             const OwnEnd saving("the state is saved first");
                             ::raise(SIGTERM);
                           }
                           work_on_for_ever();
                         }),
            130);
}

TEST_F(Interrupt, a_second_signal_does_not_wait_for_what_is_saved) {
  EXPECT_EQ(exit_code_of(scratch,
                         [&] {
                           const OwnEnd saving("the state is saved first");
                           const PendingFile pending(scratch / "state");
                           std::ofstream(pending.path()) << "half";
                           ::raise(SIGINT);
                           ::raise(SIGTERM);
                         }),
            130);
  EXPECT_EQ(test::names_in(scratch.folder()), std::vector<std::string>{"log"});
}

TEST_F(Interrupt, heeds_the_terminal_that_closes_unless_told_to_ignore_it) {
  const auto close = [] {
    ::raise(SIGHUP);
    ::_exit(interrupted() ? 5 : 6);
  };
  EXPECT_EQ(exit_code_of(scratch, close), 5);
  const auto before = std::signal(SIGHUP, SIG_IGN);
  EXPECT_EQ(exit_code_of(scratch, close), 6);
  std::signal(SIGHUP, before);
}

TEST_F(Interrupt, loops_stop_at_their_next_look) {
  EXPECT_EQ(exit_code_of(scratch,
                         [] {
                           int done = 0;
                           try {
                             for (; done < 10; ++done) {
                               stop_if_interrupted("counting");
                               if (done == 3) ::raise(SIGINT);
                             }
                           } catch (const Interrupted& error) {
                             const std::string words = error.what();
                             ::_exit(words.starts_with("stopped while counting (interrupted). ") ? 10 + done : 1);
                           }
                         }),
            14);
}

TEST_F(Interrupt, work_that_threads_share_ends_with_what_is_begun) {
  const int code = exit_code_of(scratch, [] {
    std::atomic<int> done{0};
    try {
      in_threads(1'000'000, "counting", [&](std::size_t place) {
        if (place == 3) std::raise(SIGTERM);
        ++done;
      });
    } catch (const Interrupted& error) {
      ::_exit(error.faults().front().what == "stopped while counting" && done < 1'000'000 ? 0 : 1);
    }
  });
  EXPECT_EQ(code, 0) << text_of(scratch / "log");
}

}  // namespace
}  // namespace talus

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

/// Fills the stack.
int recurse(volatile char* above) {
  volatile char room[4096];
  room[0] = above[0];
  return room[0] == 0 ? recurse(room) + 1 : 0;  // a compiler that sees no end would refuse it
}
void fill_stack() {
  volatile char first = 0;
  recurse(&first);
}

TEST(CrashReportDeathTest, has_room_where_the_stack_has_none) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading reading("/a/wall.vdb", "Write it again");
        fill_stack();
      },
      ends_as_data_error, "crashed while reading /a/wall.vdb .signal 11.");
}

TEST(CrashReportDeathTest, has_room_where_that_of_another_thread_has_none) {
  EXPECT_EXIT(
      {
        report_crashes("talus-test");
        const WhileReading reading("/a/wall.vdb", "Write it again");  // another thread does
        std::thread([] {
          const CrashStack room;
          fill_stack();
        }).join();
      },
      testing::KilledBySignal(SIGSEGV), "talus-test: crashed. Where 'ulimit -s' is small, raise it");
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
