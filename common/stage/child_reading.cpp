// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/child_reading.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr const char* child_flag = "--read-in-child";
constexpr double mebi = 1 << 20;
bool served = false;  // main() has called serve_child_reading(): this program can be started for a reading

std::map<std::string, ChildReading>& readings() {
  static std::map<std::string, ChildReading> known;
  return known;
}

double size_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return error ? 0 : static_cast<double>(size);
}

/// What a whole file takes by far: compressed contents unfold some ten times.
double memory_limit(const fs::path& file) { return 2048 * mebi + 64 * size_of(file); }
/// [s]
double time_limit(const fs::path& file) { return 60 + 2 * size_of(file) / mebi; }

/// In the child: it dies with its parent, leaves no core file, and takes no more memory than that.
void limit_this_process(const fs::path& file) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers reserve far more than they use
  const auto bytes = static_cast<rlim_t>(memory_limit(file));
  const rlimit memory{bytes, bytes};
  ::setrlimit(RLIMIT_DATA, &memory);
#else
  static_cast<void>(file);
#endif
}

/// The answers of a child: a letter, and the bytes; of a fault its three parts.
std::string answer_of(const Error& error) {
  const Fault& fault = error.faults().front();
  return 'E' + fault.what + '\0' + fault.why + '\0' + fault.mend;
}

std::string answer(const ChildReading& reading, const std::vector<std::string>& words) {
  try {
    return 'R' + reading(words);
  } catch (const Error& error) {
    return answer_of(error);
  } catch (const std::bad_alloc&) {
    return "M";
  } catch (const std::exception& error) {
    return std::string("X") + error.what();
  }
}

bool write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const auto count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

/// A child that reads, and the end of its pipe.
class Child {
 public:
  explicit Child(const ChildTask& task) : task_(task) {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("a pipe cannot be made");
    from_ = ends[0];
    std::vector<std::string> words{"/proc/self/exe", child_flag, task.name, task.file.string()};
    words.insert(words.end(), task.words.begin(), task.words.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
#ifndef __SANITIZE_ADDRESS__  // libraries talk on stderr; the answer says it in our words
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#endif
    const int code = ::posix_spawn(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (code != 0) {
      id_ = -1;
      fail(std::strerror(code));
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    end();
    if (from_ >= 0) ::close(from_);
  }

  /// All that it said until it closed its end, within its time.
  std::string answer() {
    const auto begun = std::chrono::steady_clock::now();
    const std::chrono::duration<double> limit(time_limit(task_.file));
    std::string text;
    std::vector<char> part(1 << 16);
    for (;;) {
      pollfd watched{from_, POLLIN, 0};
      const int ready = ::poll(&watched, 1, 100);
      if (interrupted())
        throw Interrupted({"stopped while reading " + task_.file.string(), "interrupted", "Start it again"});
      if (std::chrono::steady_clock::now() - begun > limit)
        refuse_file(task_.file, "cannot be read",
                    fmt::format("to read it takes longer than {:.0f} s: it is damaged", limit.count()), task_.mend);
      if (ready <= 0) continue;
      const auto count = ::read(from_, part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return text;
      text.append(part.data(), static_cast<std::size_t>(count));
    }
  }

  /// How it ended, as waitpid() gives it; kills it where it still runs.
  int end() {
    if (id_ < 0) return 0;
    int status = 0;
    if (!closed_) ::kill(id_, SIGKILL);
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }
  /// It has closed its end, so it may end by itself.
  void let_end() { closed_ = true; }

 private:
  [[noreturn]] void fail(const std::string& why) {
    refuse_file(task_.file, "cannot be read", "the process that reads it cannot be started: " + why,
                "Free some memory or processes and start again");
  }

  const ChildTask& task_;
  pid_t id_ = -1;
  int from_ = -1;
  bool closed_ = false;
};

[[noreturn]] void pass_on_fault(const std::string& answer) {
  const auto first = answer.find('\0'), second = answer.find('\0', first + 1);
  throw DataError(
      {answer.substr(1, first - 1), answer.substr(first + 1, second - first - 1), answer.substr(second + 1)});
}

}  // namespace

KnownChildReading::KnownChildReading(const char* name, ChildReading reading) { readings()[name] = std::move(reading); }

void serve_child_reading(int argc, char** argv) {
  served = true;
  if (argc < 4 || std::strcmp(argv[1], child_flag) != 0) return;
  const auto found = readings().find(argv[2]);
  if (found == readings().end()) ::_exit(static_cast<int>(ExitCode::bug));
  limit_this_process(argv[3]);
  const std::string text = answer(found->second, {argv + 3, argv + argc});
  ::_exit(write_all(STDOUT_FILENO, text) ? 0 : static_cast<int>(ExitCode::bug));  // clean-up might crash or hang yet
}

std::string read_in_child(const ChildTask& task) {
  if (!served) {
    std::vector<std::string> words{task.file.string()};
    words.insert(words.end(), task.words.begin(), task.words.end());
    return readings().at(task.name)(words);
  }
  Child child(task);
  std::string answer = child.answer();
  child.let_end();
  const int status = child.end();
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    refuse_file(task.file, "cannot be read",
                fmt::format("it is damaged: the library that reads it crashed on it ({})", ::strsignal(signal)),
                task.mend);
  }
  if (WEXITSTATUS(status) != 0 || answer.empty())
    refuse_file(task.file, "cannot be read", "it is damaged: reading it broke off", task.mend);
  if (answer[0] == 'E') pass_on_fault(answer);
  if (answer[0] == 'M') {
    refuse_file(task.file, "cannot be read",
                fmt::format("it asks for more than {:.0f} MiB of memory: it is damaged, or far too fine",
                            memory_limit(task.file) / mebi),
                task.mend);
  }
  if (answer[0] != 'R') refuse_file(task.file, "cannot be read", "it is damaged: " + answer.substr(1), task.mend);
  answer.erase(0, 1);
  return answer;
}

}  // namespace talus
