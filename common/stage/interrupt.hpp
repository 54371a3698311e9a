// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C and SIGTERM: a flag that loops ask for, and the end of a process that does not ask in time.
#pragma once

#include <filesystem>
#include <string>

namespace talus {

/// From now on SIGINT, SIGTERM and SIGHUP (unless nohup had it ignored) set interrupted(). A stage that has not ended
/// `grace` seconds later, because a library keeps it busy, is ended with 130: it has nothing to save, its partial files
/// are removed, and results carry their names only when they are whole. A second signal ends it at once. `program`
/// stands in the message.
/// The function installs handlers for the process; the calling thread's context heeds them from now on.
void watch_for_interrupts(const std::string& program, double grace = 0.7);

/// Another name for those messages, where signals are watched for.
void name_for_interrupts(const std::string& program);
/// Whether this process has installed handlers.
bool signals_are_watched();
/// Whether a signal has come to the process.
bool signal_came();

/// While one lives, whoever holds it answers interrupted() by itself, because there is something to save: the process
/// is not ended after its time of grace. The signal is acknowledged on stderr at once. `saved` says what is saved: "the
/// state is saved after this step". In a context that heeds no signals it does nothing.
class OwnEnd {
 public:
  explicit OwnEnd(const char* saved);
  OwnEnd(const OwnEnd&) = delete;
  OwnEnd& operator=(const OwnEnd&) = delete;
  ~OwnEnd();

 private:
  bool acts_;
};

/// A file that goes when the process is ended by a signal: a partial one. Beyond 32 at once, or 4 kB of name, it stays
/// and the next run sweeps it. Threads may call both functions at the same time.
void doom(const std::filesystem::path& path);
/// From now on the file stays.
void spare(const std::filesystem::path& path);

}  // namespace talus
