// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C and SIGTERM: a flag that loops ask for, and the end of a process that does not ask in time. Crashes of
// libraries on damaged files: a message that names the file, and the exit code of a data error.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace talus {

/// From now on SIGINT, SIGTERM and SIGHUP (unless nohup had it ignored) set interrupted(). A stage that has not ended
/// `grace` seconds later, because a library keeps it busy, is ended with 130: it has nothing to save, its partial files
/// are removed, and results carry their names only when they are whole. A second signal ends it at once. `program`
/// stands in the message. Installs handlers for the process; the calling thread's context heeds them from now on.
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

/// Installs handlers of SIGSEGV, SIGBUS, SIGABRT and SIGFPE. During a WhileReading they print `program`, the file and
/// its remedy, and end the process with exit code 3; otherwise the signal has its default action.
void report_crashes(const std::string& program);

/// Room of its own for those handlers in a thread that Talus starts: while one lives, they report its crashes where its
/// stack is full too, and name no file that another thread reads.
class CrashStack {
 public:
  CrashStack();
  CrashStack(const CrashStack&) = delete;
  CrashStack& operator=(const CrashStack&) = delete;
  ~CrashStack();

 private:
  std::unique_ptr<char[]> room_;
};

/// Marks a file as being read by this thread, until the end of the scope. Worker threads of a library count as well.
class WhileReading {
 public:
  WhileReading(const std::filesystem::path& file, std::string remedy);
  WhileReading(const WhileReading&) = delete;
  WhileReading& operator=(const WhileReading&) = delete;
  ~WhileReading();
  const char* file() const { return file_.c_str(); }
  const char* remedy() const { return remedy_.c_str(); }

 private:
  const WhileReading* outer_;
  std::string file_, remedy_;
};

}  // namespace talus
