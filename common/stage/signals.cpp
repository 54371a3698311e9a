// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/signals.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <mutex>
#include <new>
#include <set>
#include <utility>

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "common/error.hpp"
#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

volatile std::sig_atomic_t signals_seen = 0;
std::atomic<const char*> own_end{nullptr};  ///< what is saved before the end; null: nothing is, and the grace counts
itimerval grace_left{};
std::atomic<const char*> program_name{"talus"};
std::atomic<bool> signals_watched{false};

/// Paths that a handler may read at any time: their memory is never given back.
struct Slot {
  enum State { unused, being_filled, filled };
  std::atomic<int> state{unused};
  std::array<char, 4096> path{};
};
std::array<Slot, 32> doomed;
std::mutex naming;  // who compares names must not meet one that another thread writes; handlers do not wait for it

static_assert(std::atomic<int>::is_always_lock_free && std::atomic<const char*>::is_always_lock_free);

/// The handlers call what POSIX allows in them, and setitimer, which is a bare system call here.
void say(std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) return;  // nobody is left to tell
}

void remove_doomed() {
  for (Slot& slot : doomed)
    if (slot.state.load() == Slot::filled) ::unlink(slot.path.data());
}

[[noreturn]] void end_at_once(ExitCode code) {
  remove_doomed();
  ::_exit(static_cast<int>(code));
}

extern "C" void talus_on_signal(int) {
  if (signals_seen != 0) end_at_once(ExitCode::interrupted);
  signals_seen = 1;
  if (const char* saved = own_end.load(); saved != nullptr)
    say({"\n", program_name.load(), ": interrupted; ", saved, " (a second Ctrl-C ends it at once)\n"});
  else
    ::setitimer(ITIMER_REAL, &grace_left, nullptr);
}

/// The limit of processor time comes near; the system repeats the signal every second until it kills the process.
extern "C" void talus_on_processor_time(int) {
  static volatile std::sig_atomic_t times = 0;
  times = times + 1;
  if (times > 2) end_at_once(ExitCode::interrupted);
  if (times > 1) return;
  say({"\n", program_name.load(), ": the limit of processor time comes near; raise it (ulimit -t)\n"});
  if (signals_seen == 0) talus_on_signal(SIGXCPU);
}

extern "C" void talus_on_end_of_grace(int) {
  if (own_end.load() != nullptr) return;
  say({"\n", program_name.load(),
       ": ended in the middle of its work (interrupted). What carries a final name is whole; run the stage again\n"});
  end_at_once(ExitCode::interrupted);
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // a library in the middle of a write must not see EINTR
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

/// The name that the handler finds the file by, wherever the process stands.
std::string whole_name(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::absolute(path, ignored).string();
}

/// `ulimit -t` sets the time of the signal and that of the kill alike: the signal comes earlier, so that there is time
/// to save what there is.
void hear_of_processor_time() {
  constexpr rlim_t ahead = 3;  // s: a signal each second, the last of which ends the process
  rlimit limit{};
  if (::getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  if (limit.rlim_cur == limit.rlim_max && limit.rlim_max > ahead) {
    limit.rlim_cur = limit.rlim_max - ahead;
    ::setrlimit(RLIMIT_CPU, &limit);
  }
  handle(SIGXCPU, talus_on_processor_time);
}

bool is_ignored(int number) {
  struct sigaction now {};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

std::array<char, 128> crashing_program{};
thread_local constinit const WhileReading* read_here = nullptr;
std::atomic<const WhileReading*> read_anywhere{nullptr};  // for worker threads of libraries: the file begun last
thread_local constinit bool is_ours = false;              // a thread that says itself what it reads

static_assert(std::atomic<const WhileReading*>::is_always_lock_free);

extern "C" void talus_on_crash(int signal) {
  const WhileReading* reading = read_here != nullptr || is_ours ? read_here : read_anywhere.load();
  if (reading == nullptr) {
    remove_doomed();
    say({crashing_program.data(), signal == SIGSEGV ? ": crashed. Where 'ulimit -s' is small, raise it; else this is a "
                                                      "bug: please report it, with the recipe and the version\n"
                                                    : ": crashed (this is a bug). Please report it, with the recipe "
                                                      "and the version\n"});
    ::raise(signal);  // SA_RESETHAND: the default action, once this handler has returned
    return;
  }
  const char number[3]{static_cast<char>('0' + signal / 10), static_cast<char>('0' + signal % 10), '\0'};
  say({crashing_program.data(), ": crashed while reading ", reading->file(), " (signal ",
       signal < 10 ? number + 1 : number, "): the file is damaged. ", reading->remedy(), "\n"});
  end_at_once(ExitCode::data);
}

}  // namespace

void name_for_interrupts(const std::string& program) {
  static std::mutex mutex;
  static std::set<std::string> names;  // a handler may read one at any time: none is ever removed
  const std::lock_guard lock(mutex);
  program_name = names.insert(program).first->c_str();
}

void watch_for_interrupts(const std::string& program, double grace) {
  name_for_interrupts(program);
  context().heed_signals();
  signals_watched = true;
  grace_left.it_value.tv_sec = static_cast<time_t>(grace);
  grace_left.it_value.tv_usec = static_cast<suseconds_t>((grace - std::floor(grace)) * 1e6);
  handle(SIGALRM, talus_on_end_of_grace);
  handle(SIGINT, talus_on_signal);
  handle(SIGTERM, talus_on_signal);
  hear_of_processor_time();
  handle(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` then fails as one on a full disk does
  if (!is_ignored(SIGHUP)) handle(SIGHUP, talus_on_signal);  // nohup
}

bool signals_are_watched() { return signals_watched; }

bool signal_came() { return signals_seen != 0; }

bool interrupted() { return context().is_interrupted(); }

void stop_if_interrupted(const std::string& doing) {
  if (interrupted())
    throw Interrupted(
        {"stopped while " + doing, "interrupted", "What carries a final name is whole; run the stage again"});
}

OwnEnd::OwnEnd(const char* saved) : acts_(context().heeds_signals()) {
  if (!acts_) return;
  own_end.store(saved);
  const itimerval never{};
  if (signal_came()) ::setitimer(ITIMER_REAL, &never, nullptr);
}

OwnEnd::~OwnEnd() {
  if (!acts_) return;
  own_end.store(nullptr);
  const bool saved = std::uncaught_exceptions() > 0;  // on the way out, which may take as long as it takes
  if (signal_came() && !saved) ::setitimer(ITIMER_REAL, &grace_left, nullptr);
}

void doom(const std::filesystem::path& path) {
  const std::string name = whole_name(path);
  if (name.size() >= Slot{}.path.size()) return;
  const std::lock_guard lock(naming);
  for (Slot& slot : doomed) {
    int expected = Slot::unused;
    if (!slot.state.compare_exchange_strong(expected, Slot::being_filled)) continue;
    std::memcpy(slot.path.data(), name.c_str(), name.size() + 1);
    slot.state.store(Slot::filled);
    return;
  }
}

void spare(const std::filesystem::path& path) {
  const std::string name = whole_name(path);
  const std::lock_guard lock(naming);
  for (Slot& slot : doomed)
    if (slot.state.load() == Slot::filled && name == slot.path.data()) slot.state.store(Slot::unused);
}

namespace {

constexpr std::size_t handler_room = std::size_t{1} << 16;  // recursion without end leaves no room on the other stack

void give_to_handlers(char* room) {
  const stack_t stack{.ss_sp = room, .ss_flags = room == nullptr ? SS_DISABLE : 0, .ss_size = handler_room};
  ::sigaltstack(&stack, nullptr);
}

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
CrashStack::CrashStack() : room_(new (std::nothrow) char[handler_room]) {
  give_to_handlers(room_.get());
  is_ours = true;
}
CrashStack::~CrashStack() { give_to_handlers(nullptr); }
#else
CrashStack::CrashStack() = default;
CrashStack::~CrashStack() = default;
#endif

void report_crashes(const std::string& program) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers report crashes themselves
  program.copy(crashing_program.data(), crashing_program.size() - 1);
  static std::array<char, handler_room> handler_stack;
  give_to_handlers(handler_stack.data());
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
