// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Files: faults of those that cannot be written or are refused, what an input must be to be opened, texts read whole,
// and one process at a time in an output folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <ios>
#include <optional>
#include <string>

#include "common/error.hpp"

namespace talus {

/// "PATH: cannot be written (REASON). mend". Libraries seldom say that the disk is full, so the file system is asked.
Fault write_fault(const std::filesystem::path& path, const std::string& reason);

/// The system's words for an errno; of 0 that it gave no reason.
std::string reason_of(int code);

/// This function throws the DataError "PATH: what (why). mend".
[[noreturn]] inline void refuse_file(const std::filesystem::path& path, const std::string& what, const std::string& why,
                                     const std::string& mend) {
  throw DataError({path.string() + ": " + what, why, mend});
}

/// Refuses a file of another format number than the one that this program reads.
[[noreturn]] inline void refuse_format(const std::filesystem::path& path, std::int64_t found, std::int64_t known,
                                       const std::string& mend) {
  refuse_file(path, "format " + std::to_string(found), "this version reads " + std::to_string(known), mend);
}

/// Refuses a folder that results cannot be written to.
[[noreturn]] void refuse_output_folder(const std::filesystem::path& folder, const std::string& reason);

/// Throws DataError where `file` is a pipe, a socket or a device: inputs are read from several places, some of them
/// twice, and a pipe that nobody writes to would be waited for without end. What is missing, a file or a folder passes.
void require_plain(const std::filesystem::path& file);

/// Throws DataError where a reading of `stream` has failed: it ends what is read as the end of the file does.
void require_read(const std::ios& stream, const std::filesystem::path& file);

/// The first bytes of a plain file, `most` or fewer; empty where it is none. Throws as require_read().
std::string start_of(const std::filesystem::path& file, std::size_t most);

/// All bytes of a plain file that a stage wrote, if it is there. Throws DataError: not readable, longer than 64 MB.
std::optional<std::string> text_if_there(const std::filesystem::path& file);

/// True where inputs may name places on a network (--network), in the calling thread's context.
bool network_allowed();

class Context;

/// The lock of an output folder, ".talus.lock" in it, which names its holder. Processes that do parts of a stage's work
/// have one each, ".talus.PART.lock": their files have names of their own. The system lets go of it when the process
/// ends, however it ends; a file that a killed process left is no lock. Reading what lies in the folder needs none. The
/// lock belongs to the calling thread's context: stages that run in the context of its holder take no second one.
class OutputLock {
 public:
  /// Takes the lock for `program`, and for the `part` of its work where that is not empty. Throws DataError: another
  /// process holds it (who, where, since when), or nothing can be written there. Where the file system knows no locks
  /// (some network file systems) it warns and goes on: each file is still written aside under a name of this process's
  /// own and carries the id of its run.
  OutputLock(const std::filesystem::path& folder, const std::string& program, const std::string& part = {});
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  ~OutputLock();

 private:
  Context& context_;
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// The file that is locked.
std::filesystem::path lock_file_of(const std::filesystem::path& folder, const std::string& part = {});

/// True while the calling thread's context holds a lock: partial files in its folder are then of killed processes.
bool holds_output_lock();

/// "2026-11-28 16:01:00 UTC".
std::string utc_now();

/// A word for this process that no other has, for names of partial files: "1234-9f3c21ab".
const std::string& process_word();

}  // namespace talus
