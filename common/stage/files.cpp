// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/files.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <random>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/stage/context.hpp"
#include "common/stage/inside.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"
#include "common/whole_text.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// Output folders that this process has locked: what it knows of a folder from an earlier lock may be old.
std::atomic<unsigned> locks_taken{0};

/// What a file is that is no plain file; null of a plain one, a folder and one that is not there.
const char* kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::fifo: return "it is a pipe";
    case fs::file_type::socket: return "it is a socket";
    case fs::file_type::character:
    case fs::file_type::block: return "it is a device";
    default: return nullptr;
  }
}

/// Force a file or folder to the disk; returns errno, or 0. Late write errors (quota, network disks) show up here.
int sync_to_disk(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int synced = ::fsync(descriptor) == 0 ? 0 : errno;
  const int closed = ::close(descriptor) == 0 ? 0 : errno;
  return synced != 0 ? synced : closed;
}

/// Forces what was renamed, made or removed in a folder to the disk. Some file systems refuse to sync a folder, or to
/// open one that may only be written to: then there is no more to do. All else is a fault: a power cut could undo it.
void sync_folder(const fs::path& folder) {
  const fs::path place = folder.empty() ? fs::path(".") : folder;
  const int code = sync_to_disk(place, O_RDONLY | O_DIRECTORY);
  for (const int refused : {0, EINVAL, ENOTSUP, ENOSYS, EBADF, EACCES, EPERM})
    if (code == refused) return;
  Fault fault = write_fault(place, reason_of(code));
  fault.what = place.string() + ": the folder cannot be saved; after a power cut it may be as it was before";
  throw DataError(fault);
}

/// ".NAME."
std::string stem_of_partials(const fs::path& file) { return "." + file.filename().string() + "."; }

/// Partial files of other processes in folders that are this one's own. A folder is listed once under a lock: who wrote
/// a file of these names has ended before, and to list it again for every file would take longer than to write them
/// where there are thousands.
class Leftovers {
 public:
  /// The partial files of this name that killed processes left, and what GDAL left beside those.
  std::vector<fs::path> of(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const std::string stem = stem_of_partials(file);
    const std::lock_guard lock(mutex_);
    if (const unsigned now = locks_taken; of_lock_ != now) {
      names_.clear();
      of_lock_ = now;
    }
    const auto [found, is_new] = names_.try_emplace(folder);
    if (is_new) found->second = listed(folder);
    std::vector<fs::path> left;
    for (const std::string& name : found->second)
      if (name.starts_with(stem)) left.push_back(folder / name);
    return left;
  }

 private:
  static std::vector<std::string> listed(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; entry != end && !ignored; entry.increment(ignored)) {
      std::string name = entry->path().filename().string();
      const bool own = name.find(process_word()) != std::string::npos;
      if (name.starts_with('.') && name.find(".partial") != std::string::npos && !own) names.push_back(std::move(name));
    }
    return names;
  }

  std::mutex mutex_;
  std::map<fs::path, std::vector<std::string>> names_;
  unsigned of_lock_ = 0;
};

void sweep(const fs::path& file) {
  static Leftovers leftovers;
  std::error_code ignored;
  for (const fs::path& path : leftovers.of(file)) fs::remove(path, ignored);
}

std::string host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
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

[[noreturn]] void refuse_to_replace(const fs::path& path, const char* kind) {
  refuse_file(path, "cannot be written", kind, "Remove it, or write elsewhere with --out DIR");
}

[[noreturn]] void refuse_second(const fs::path& file, int descriptor) {
  const std::string name = holder(descriptor);
  ::close(descriptor);
  throw DataError({fmt::format("{}: in use by {}", file.parent_path().string(), name),
                   "two processes that write into one folder would mix their results",
                   "Wait for it or end it, or write elsewhere with --out DIR"});
}

/// Opens the file of a lock. What a link, a pipe or another name of the same file leads to is not written into.
int open_lock(const fs::path& file) {
  require_replaceable(file);
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (descriptor < 0 && errno == ELOOP) require_replaceable(file);
  if (descriptor < 0) refuse_output_folder(file.parent_path(), reason_of(errno));
  struct stat found {};
  if (::fstat(descriptor, &found) == 0 && S_ISREG(found.st_mode) && found.st_nlink <= 1) return descriptor;
  ::close(descriptor);
  refuse_to_replace(file, found.st_nlink > 1 ? "it is a file of several names" : "it is no plain file");
}

/// Locks the file of this name. One that its holder removed in between is no lock for those who come later. `is_held`
/// stays false where the file system knows no locks.
int lock(const fs::path& file, bool& is_held) {
  while (true) {
    const int descriptor = open_lock(file);
    int code = 0;
    do code = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    while (code == EINTR);
    if (code == EWOULDBLOCK) refuse_second(file, descriptor);
    if (code != 0) {
      // No finding: it is of the folder, and results are the same without it.
      log_warning(fmt::format(
          "{}: this file system knows no locks ({}): nothing keeps a second process out of the folder; see that none "
          "writes there",
          file.parent_path().string(), reason_of(code)));
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
  refuse_output_folder(file.parent_path(), reason_of(errno != 0 ? errno : ENOSPC));
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::time(nullptr))); }

void require_plain(const fs::path& file) {
  std::error_code unknown;
  const char* kind = kind_of(fs::status(file, unknown).type());
  if (kind != nullptr)
    refuse_file(file, "cannot be read", kind, "Give a plain file: it is read from several places, some of them twice");
}

void require_inside(const fs::path& path) {
  fs::path link;
  std::error_code unknown;
  for (fs::path way = path.parent_path(); way.has_relative_path(); way = way.parent_path()) {
    if (context().has_locked(way)) {
      if (!link.empty()) refuse_to_replace(link, "it is a link: results stay in --out");
      return;
    }
    if (fs::is_symlink(fs::symlink_status(way, unknown))) link = way;
  }
}

void require_replaceable(const fs::path& file) {
  require_inside(file);
  std::error_code unknown;
  const fs::file_type type = fs::symlink_status(file, unknown).type();
  if (type == fs::file_type::symlink) refuse_to_replace(file, "it is a link: results stay in --out");
  if (type == fs::file_type::directory) refuse_to_replace(file, "it is a folder");
  if (const char* kind = kind_of(type); kind != nullptr) refuse_to_replace(file, kind);
}

void require_read(const std::ios& stream, const fs::path& file) {
  if (stream.bad())
    refuse_file(file, "cannot be read to its end", reason_of(errno), "Look at the disk, or copy the file again");
}

std::string start_of(const fs::path& file, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";  // also what only GDAL knows: /vsizip/..., NETCDF:...
  std::ifstream stream(file, std::ios::binary);
  std::string start(most, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  require_read(stream, file);
  start.resize(static_cast<std::size_t>(stream.gcount()));
  return start;
}

std::optional<std::string> text_if_there(const fs::path& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  if (type == fs::file_type::not_found) return std::nullopt;
  require_plain(file);
  return whole_text(file, std::uintmax_t{64} << 20, [&](const std::string& reason) {
    refuse_file(file, "cannot be read", reason, "Look at its permissions and at the disk, or make it again");
  });
}

bool network_allowed() { return context().network; }

Fault write_fault(const fs::path& path, const std::string& reason) {
  constexpr std::uintmax_t nearly_nothing = 64 * 1024;  // file systems keep a few blocks back
  std::error_code ignored;
  const fs::space_info space = fs::space(path.has_parent_path() ? path.parent_path() : fs::path("."), ignored);
  const bool full =
      (!ignored && space.available < nearly_nothing) || reason.find(reason_of(ENOSPC)) != std::string::npos;
  const std::string what = path.string() + ": cannot be written";
  if (full)
    return {what, "the disk is full" + (reason.empty() ? "" : ": " + reason),
            "Free some space, or write elsewhere with --out DIR"};
  if (reason.find(reason_of(EFBIG)) != std::string::npos)
    return {what, "it is longer than this process may write: " + reason, "Raise the limit on files (ulimit -f)"};
  return {what, reason, "Check the folder's permissions and free space, or write elsewhere with --out DIR"};
}

std::string reason_of(int code) {
  return code != 0 ? std::generic_category().message(code) : "the system gave no reason";
}

void refuse_output_folder(const fs::path& folder, const std::string& reason) {
  refuse_file(folder, "the output folder cannot be written to", reason, "Name another one with --out DIR");
}

PendingFile::PendingFile(fs::path final_path)
    : final_(std::move(final_path)),
      partial_(final_.parent_path() / fmt::format("{}{}.partial", stem_of_partials(final_), process_word())) {
  require_replaceable(final_);
  doom(partial_);
  if (holds_output_lock()) sweep(final_);
}

PendingFile::~PendingFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(partial_, ignored);
  fs::remove(partial_.string() + ".aux.xml", ignored);  // what GDAL leaves beside a file that it could not finish
  spare(partial_);
}

void PendingFile::commit(const fs::path& name) {
  if (const int code = sync_to_disk(partial_, O_RDONLY); code != 0) throw DataError(write_fault(name, reason_of(code)));
  if (::rename(partial_.c_str(), name.c_str()) != 0) throw DataError(write_fault(name, reason_of(errno)));
  committed_ = true;
  spare(partial_);
  sync_folder(name.parent_path());  // where the rename itself lives
}

void make_folder(const fs::path& folder) {
  require_inside(folder / "");
  if (fs::is_directory(folder)) return;
  const fs::path above = folder.parent_path();
  if (!above.empty() && above != folder) make_folder(above);
  std::error_code error;
  if (const char* kind = kind_of(fs::status(folder, error).type()); kind != nullptr) refuse_to_replace(folder, kind);
  fs::create_directory(folder, error);
  if (error)
    throw DataError(
        {folder.string() + ": the folder cannot be made", error.message(), "Choose another one with --out DIR"});
  sync_folder(above);
}

void remove_for_good(const fs::path& file) {
  require_inside(file);
  std::error_code none_there;
  if (fs::remove(file, none_there)) sync_folder(file.parent_path());
}

void write_text(const fs::path& path, const std::string& text) {
  PendingFile pending(path);
  errno = 0;
  std::ofstream stream(pending.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw DataError(write_fault(path, reason_of(errno)));
  pending.commit();
}

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

const std::string& process_word() {
  static const std::string word = fmt::format("{}-{:08x}", ::getpid(), std::random_device{}());
  return word;
}

}  // namespace talus
