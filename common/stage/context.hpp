// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The surroundings of a computation: log, threads, network, names of paths, locked folders, interruption.
//
// A program or a user of the library makes a Context and binds it to a thread. The functions of this folder
// (log_info(), thread_limit(), interrupted(), ...) use the context of the calling thread. Two contexts in one process
// are independent of each other. They share what a process has once:
// - handlers of SIGINT, SIGTERM, SIGHUP and SIGALRM with their flag, and the names of partial files that a handler
//   removes (signals.cpp). Only watch_for_interrupts() installs handlers.
// - the number of threads that oneTBB, OpenMP and OpenBLAS use (common/domain/threads.cpp); the state of CUDA.
// - drivers and settings of GDAL, PROJ, HDF5 and OpenVDB, made at their first use.
// - environment variables, the current folder, the progress line on the terminal (context.cpp), and the word of this
//   process in names of partial files with the count of its locks (files.cpp).
// - the handler of crashes while a library reads a file: after report_crashes() in main().
// - the context of threads to which none is bound, such as those of oneTBB.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/recipe/paths.hpp"

namespace talus {

/// How much is said on stderr: errors alone, with advice, warnings and progress (brief), with information, with
/// details.
enum class Verbosity { quiet, brief, normal, verbose };

/// The kind of a line of the log. `progress` is a line that replaces the one before.
enum class LogLevel { detail, progress, info, advice, warning, error };

/// Takes the lines of a log: the text without a prefix ("warning: ").
using LogSink = std::function<void(LogLevel level, const std::string& text)>;

class Context {
 public:
  /// A context that logs to stderr.
  Context() = default;
  /// A context that logs to `log`, one line at a time, from any thread. It needs no terminal.
  explicit Context(LogSink log) : sink_(std::move(log)) {}
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  Verbosity verbosity = Verbosity::normal;  ///< lines below it are not shown
  int threads = 0;                          ///< to use at most; 0: usable_threads()
  bool network = false;                     ///< inputs may name places on a network

  /// Asks the computations of this context, from any thread, to stop as Ctrl-C does: they save, and throw Interrupted.
  void interrupt() { interrupted_ = true; }
  bool is_interrupted() const;
  /// Whether signals of the process interrupt this context: after watch_for_interrupts() in it.
  bool heeds_signals() const { return heeds_signals_; }
  void heed_signals() { heeds_signals_ = true; }

  /// Writes a line to the log, with paths as they are shown and without control characters.
  void log(LogLevel level, const std::string& text);
  /// Whether lines go to stderr, where a terminal may be; whether one is.
  bool logs_to_stderr() const { return !redirect_ && !sink_; }
  bool logs_to_terminal() const;
  /// From now on keeps what log() gets but progress, whatever is shown, each line behind the time since [s].
  void start_record();
  std::string end_record();  ///< the lines since start_record()

  ShownPaths& paths() { return *paths_; }  ///< names of paths in the log and in the report

  /// SHA-256 of files as they were read; empty where a file was not.
  void note_checksum(const std::filesystem::path& file, std::string digest);
  std::string checksum_of(const std::filesystem::path& file) const;

  /// Output folders that this context has locked. `held`: the file system knows locks.
  void add_lock(const std::filesystem::path& file, bool held);
  void remove_lock(const std::filesystem::path& file);
  bool has_locked(const std::filesystem::path& folder) const;
  bool holds_a_lock() const;

 private:
  friend class RedirectLog;
  friend Context& context();
  struct Lock {
    std::filesystem::path file;
    bool held;
  };
  bool shows(LogLevel level) const;

  mutable std::mutex mutex_;
  LogSink sink_;      ///< empty: stderr
  LogSink redirect_;  ///< of RedirectLog; empty: none
  ShownPaths own_paths_;
  ShownPaths* paths_ = &own_paths_;
  std::vector<Lock> locks_;
  std::map<std::filesystem::path, std::string> checksums_;
  std::optional<std::chrono::steady_clock::time_point> recorded_since_;
  std::string record_;
  std::atomic<bool> interrupted_{false}, heeds_signals_{false};
};

/// The context of the calling thread.
Context& context();

/// Take a drawn progress line off the terminal, so that the next output starts on a clean line.
void clear_progress_line();

/// An error line on stderr, shown even under -q.
void log_error(const std::string& text);

/// Binds a context to the calling thread while the object lives.
class BindContext {
 public:
  explicit BindContext(Context& bound);
  ~BindContext();
  BindContext(const BindContext&) = delete;
  BindContext& operator=(const BindContext&) = delete;

 private:
  Context* previous_;
  BindShownPaths paths_;
};

/// While the object lives, `sink` gets all lines of the calling thread's context; details only where it is verbose.
class RedirectLog {
 public:
  explicit RedirectLog(LogSink sink);
  ~RedirectLog();
  RedirectLog(const RedirectLog&) = delete;
  RedirectLog& operator=(const RedirectLog&) = delete;

 private:
  Context& context_;
  LogSink previous_;
};

}  // namespace talus
