// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs of a run. Each is a Writer in a source of its own, entered in writers/list.cpp (docs/how-to/extend.md).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace talus::postprocess {

struct Job;  // writers/job.hpp

using Files = std::vector<std::filesystem::path>;

/// One output: the words that ask for it, the names of its files, and the code that writes them.
class Writer {
 public:
  virtual ~Writer() = default;
  /// Unique name in the list: "netcdf".
  virtual std::string name() const = 0;
  /// Words of [postprocess] outputs that ask for it.
  virtual std::vector<std::string_view> words() const { return {}; }
  /// True if the recipe asks for the output and the run has its data.
  virtual bool wanted(const Job& /*job*/) const { return true; }
  /// Throws DataError if a wanted output lacks frames, a program or space. Called before any file is written.
  virtual void check(const Job& /*job*/) const {}
  /// Shell patterns of all files that the writer can write, relative to the output folder.
  virtual std::vector<std::string> names() const = 0;
  /// Patterns of the files of an earlier run that are deleted before the first writer starts. A writer whose files
  /// every run replaces returns none.
  virtual std::vector<std::string> outdated() const { return names(); }
  /// True if write() may run beside other writers: it calls neither HDF5 nor GDAL, and finds nothing doubtful.
  virtual bool stands_alone() const { return false; }
  /// Writes the files, each aside and renamed. Returns the paths to print. Throws DataError, Interrupted.
  virtual Files write(const Job& job) const = 0;
};

/// All writers in the order of writing. Copies share the writers.
class Writers {
 public:
  Writers();
  /// Words of all writers.
  std::vector<std::string_view> words() const;
  /// Calls check() of the wanted writers.
  void check(const Job& job) const;
  /// Deletes the outdated files under `out`, in reverse order of writing: score.json, which marks complete results,
  /// goes first.
  void remove_outdated(const std::filesystem::path& out) const;
  /// Runs the wanted writers, those that stand alone in a thread beside the others, and the last one at the end.
  /// Returns the paths to print.
  Files write(const Job& job) const;

  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

 private:
  std::vector<std::shared_ptr<Writer>> all_;
};

/// Makes the writers (writers/list.cpp).
std::vector<std::shared_ptr<Writer>> all_writers();

/// True if a path relative to the output folder matches one of the patterns.
bool matches(const std::vector<std::string>& patterns, const std::string& path);

}  // namespace talus::postprocess
