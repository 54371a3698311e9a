// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/crash_report.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <utility>

#include "common/error.hpp"

namespace talus {
namespace {

std::array<char, 128> crashing_program{};
thread_local constinit const WhileReading* read_here = nullptr;
std::atomic<const WhileReading*> read_anywhere{nullptr};  // for worker threads: the file begun last

static_assert(std::atomic<const WhileReading*>::is_always_lock_free);

/// Handlers may call write(), but neither allocate nor lock.
void say_crash(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody is left to tell
}

extern "C" void talus_on_crash(int signal) {
  const WhileReading* reading = read_here != nullptr ? read_here : read_anywhere.load();
  if (reading == nullptr) {
    ::raise(signal);  // SA_RESETHAND: the default action, once this handler has returned
    return;
  }
  const char number[3]{static_cast<char>('0' + signal / 10), static_cast<char>('0' + signal % 10), '\0'};
  for (const char* part :
       {static_cast<const char*>(crashing_program.data()), ": crashed while reading ", reading->file(), " (signal ",
        signal < 10 ? number + 1 : number, "): the file is damaged. ", reading->remedy(), "\n"})
    say_crash(part);
  ::_exit(static_cast<int>(ExitCode::data));
}

}  // namespace

void report_crashes(const std::string& program) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers report crashes themselves
  program.copy(crashing_program.data(), crashing_program.size() - 1);
  static std::array<char, std::size_t{1} << 16> handler_stack;  // recursion without end leaves no room on the other
  const stack_t stack{.ss_sp = handler_stack.data(), .ss_flags = 0, .ss_size = handler_stack.size()};
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = talus_on_crash;
  action.sa_flags = SA_ONSTACK | static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE}) ::sigaction(signal, &action, nullptr);
#else
  static_cast<void>(program);
#endif
}

WhileReading::WhileReading(const std::filesystem::path& file, std::string remedy)
    : outer_(read_here), file_(file.string()), remedy_(std::move(remedy)) {
  read_here = this;
  read_anywhere = this;
}

WhileReading::~WhileReading() {
  read_here = outer_;
  const WhileReading* self = this;
  read_anywhere.compare_exchange_strong(self, outer_);
}

}  // namespace talus
