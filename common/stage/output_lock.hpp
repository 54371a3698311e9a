// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One process at a time in an output folder.
#pragma once

#include <filesystem>
#include <string>

namespace talus {

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

/// True while the calling thread's context holds the lock of an output folder: a partial file there is then one that a
/// killed process left.
bool holds_output_lock();

/// How many such locks this process has taken: what it knows of a folder from an earlier one may be old.
unsigned output_locks_taken();

/// A word for this process that no other has, for names of partial files: "1234-9f3c21ab".
const std::string& process_word();

}  // namespace talus
