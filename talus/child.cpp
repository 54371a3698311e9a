// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "common/error.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

std::atomic<pid_t> child = 0;

void pass_on(int signal) {
  const int kept = errno;
  if (const pid_t process = child; process > 0) ::kill(process, signal);
  errno = kept;
}

/// Terminals send Ctrl-C and the end of a session to every process in the foreground.
void heard(int /*signal*/) {}

/// While one lives, signals do not end this process: it waits for the program that they end.
class Waiting {
 public:
  explicit Waiting(pid_t process) {
    child = process;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      struct sigaction action {};
      action.sa_handler = signals[i] == SIGTERM ? pass_on : heard;
      ::sigaction(signals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) ::sigaction(signals[i], &action, nullptr);
    }
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
  ~Waiting() {
    for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before_[i], nullptr);
    child = 0;
  }

 private:
  static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals.size()> before_{};
};

/// A pipe whose writing end becomes a stream of the child.
class Pipe {
 public:
  Pipe(posix_spawn_file_actions_t& actions, int stream) {
    if (::pipe2(ends_, O_CLOEXEC) == 0) ::posix_spawn_file_actions_adddup2(&actions, ends_[1], stream);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close(0);
    close(1);
  }
  void close(int end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }
  int reading() const { return ends_[0]; }

 private:
  int ends_[2] = {-1, -1};
};

/// One reading of what is there; closes the pipe at its end.
void take(Pipe& pipe, std::string& text) {
  std::array<char, 1 << 14> part{};
  const auto count = ::read(pipe.reading(), part.data(), part.size());
  if (count > 0) text.append(part.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EINTR)) pipe.close(0);
}

void take_all(Pipe& out, Pipe& err, Outcome& outcome) {
  while (out.reading() >= 0 || err.reading() >= 0) {
    pollfd watched[2] = {{out.reading(), POLLIN, 0}, {err.reading(), POLLIN, 0}};
    if (::poll(watched, 2, -1) < 0) continue;  // a signal
    if (watched[0].revents != 0) take(out, outcome.out);
    if (watched[1].revents != 0) take(err, outcome.err);
  }
}

}  // namespace

Outcome run_program(const fs::path& program, const std::vector<std::string>& arguments, Keep keep) {
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), program.string());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  Outcome outcome;
  {
    posix_spawn_file_actions_t nowhere;
    ::posix_spawn_file_actions_init(&nowhere);
    Pipe out(keep == Keep::nothing ? nowhere : actions, STDOUT_FILENO);
    Pipe err(keep == Keep::everything ? actions : nowhere, STDERR_FILENO);
    ::posix_spawn_file_actions_destroy(&nowhere);
    pid_t process = -1;
    const int fault = ::posix_spawn(&process, pointers[0], &actions, nullptr, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    out.close(1);
    err.close(1);
    if (fault != 0)
      throw DataError(Fault{program.string() + ": cannot be started", std::strerror(fault), "Install Talus again"});
    const Waiting waiting(process);
    take_all(out, err, outcome);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return outcome;
}

fs::path program_of(const std::string& stage) {
  fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / ("talus-" + stage);
  if (::access(program.c_str(), X_OK) != 0)
    throw DataError(Fault{program.string() + " is missing",
                          "talus runs the program of each stage, which lies beside it",
                          "Build them: make build; or install Talus again"});
  return program;
}

}  // namespace talus::command
