// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <map>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/stage/interrupt.hpp"
#include "common/stage/output_lock.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

std::string reason_of(int code) { return std::generic_category().message(code); }

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
    if (const unsigned now = output_locks_taken(); of_lock_ != now) {
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

}  // namespace

Fault write_fault(const fs::path& path, const std::string& reason) {
  constexpr std::uintmax_t nearly_nothing = 64 * 1024;  // file systems keep a few blocks back
  std::error_code ignored;
  const fs::space_info space = fs::space(path.has_parent_path() ? path.parent_path() : fs::path("."), ignored);
  const bool full =
      (!ignored && space.available < nearly_nothing) || reason.find(reason_of(ENOSPC)) != std::string::npos;
  Fault fault{path.string() + ": cannot be written", reason, ""};
  if (full) {
    fault.why = "the disk is full" + (reason.empty() ? "" : ": " + reason);
    fault.mend = "Free some space, or write elsewhere with --out DIR";
  } else {
    fault.mend = "Check the folder's permissions and free space, or write elsewhere with --out DIR";
  }
  return fault;
}

PendingFile::PendingFile(fs::path final_path)
    : final_(std::move(final_path)),
      partial_(final_.parent_path() / fmt::format("{}{}.partial", stem_of_partials(final_), process_word())) {
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

void PendingFile::commit() {
  if (const int code = sync_to_disk(partial_, O_RDONLY); code != 0)
    throw DataError(write_fault(final_, reason_of(code)));
  if (::rename(partial_.c_str(), final_.c_str()) != 0) throw DataError(write_fault(final_, reason_of(errno)));
  committed_ = true;
  spare(partial_);
  sync_folder(final_.parent_path());  // where the rename itself lives
}

void make_folder(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  const fs::path above = folder.parent_path();
  if (!above.empty() && above != folder) make_folder(above);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error)
    throw DataError(
        {folder.string() + ": the folder cannot be made", error.message(), "Choose another one with --out DIR"});
  sync_folder(above);
}

void remove_for_good(const fs::path& file) {
  std::error_code none_there;
  if (fs::remove(file, none_there)) sync_folder(file.parent_path());
}

void write_text(const fs::path& path, const std::string& text) {
  PendingFile pending(path);
  errno = 0;
  std::ofstream stream(pending.path(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw DataError(write_fault(path, errno != 0 ? reason_of(errno) : "the system gave no reason"));
  pending.commit();
}

}  // namespace talus
