// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/output_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <random>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "common/stage/console.hpp"
#include "common/stage/context.hpp"
#include "common/stage/interrupt.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

std::atomic<unsigned> locks_taken{0};

std::string words_of(int code) { return std::generic_category().message(code); }

[[noreturn]] void refuse_folder(const fs::path& file, int code) {
  throw DataError({file.parent_path().string() + ": the output folder cannot be written to", words_of(code),
                   "Name another one with --out DIR"});
}

std::string host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text.data();
}

std::string content(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size() - 1, 0);
  return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : std::string();
}

/// Who holds the lock; the name comes a moment after the lock.
std::string holder(int descriptor) {
  using namespace std::chrono_literals;
  for (int look = 0; look < 20; ++look) {
    const std::string name = content(descriptor);
    if (const auto end = name.find('\n'); end != std::string::npos) return name.substr(0, end);
    std::this_thread::sleep_for(10ms);
  }
  return "another process, which has not said its name";
}

[[noreturn]] void refuse_second(const fs::path& file, int descriptor) {
  const std::string name = holder(descriptor);
  ::close(descriptor);
  throw DataError({fmt::format("{}: in use by {}", file.parent_path().string(), name),
                   "two processes that write into one folder would mix their results",
                   "Wait for it or end it, or write elsewhere with --out DIR"});
}

/// Locks the file of this name. One that its holder removed in between is no lock for those who come later. `is_held`
/// stays false where the file system knows no locks.
int lock(const fs::path& file, bool& is_held) {
  while (true) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) refuse_folder(file, errno);
    int code = 0;
    do code = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    while (code == EINTR);
    if (code == EWOULDBLOCK) refuse_second(file, descriptor);
    if (code != 0) {
      // No finding: it is of the folder, and results are the same without it.
      log_warning(fmt::format(
          "{}: this file system knows no locks ({}): nothing keeps a second process out of the folder; see that none "
          "writes there",
          file.parent_path().string(), words_of(code)));
      return descriptor;
    }
    struct stat mine {
    }, there{};
    if (::fstat(descriptor, &mine) == 0 && ::stat(file.c_str(), &there) == 0 && mine.st_ino == there.st_ino) {
      ++locks_taken;
      is_held = true;
      return descriptor;
    }
    ::close(descriptor);
  }
}

/// Writing the name shows, before long work begins, that the folder takes anything.
void write_holder(const fs::path& file, int descriptor, const std::string& program) {
  const std::string name = fmt::format("{} (process {} on {}, since {})\n", program, ::getpid(), host(), utc_now());
  errno = 0;
  if (::ftruncate(descriptor, 0) == 0 &&
      ::pwrite(descriptor, name.data(), name.size(), 0) == static_cast<ssize_t>(name.size()))
    return;
  refuse_folder(file, errno != 0 ? errno : ENOSPC);
}

}  // namespace

OutputLock::OutputLock(const fs::path& folder, const std::string& program, const std::string& part)
    : context_(context()), file_(lock_file_of(folder, part)) {
  bool is_held = false;
  descriptor_ = lock(file_, is_held);
  try {
    write_holder(file_, descriptor_, program);
    context_.add_lock(file_, is_held);
    doom(file_);
  } catch (...) {  // memory may run out on the way
    ::unlink(file_.c_str());
    ::close(descriptor_);
    throw;
  }
}

OutputLock::~OutputLock() {
  ::unlink(file_.c_str());  // while it is still locked: who waits for this one looks for it again
  spare(file_);
  context_.remove_lock(file_);
  ::close(descriptor_);
}

fs::path lock_file_of(const fs::path& folder, const std::string& part) {
  return folder / (part.empty() ? ".talus.lock" : ".talus." + part + ".lock");
}

bool holds_output_lock() { return context().holds_a_lock(); }

unsigned output_locks_taken() { return locks_taken; }

const std::string& process_word() {
  static const std::string word = fmt::format("{}-{:08x}", ::getpid(), std::random_device{}());
  return word;
}

}  // namespace talus
