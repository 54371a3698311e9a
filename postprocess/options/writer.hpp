// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outputs of a run. Each is a Writer, entered in writers/writers.cpp (docs/how-to/extend.md).
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus::postprocess {

struct Job;  // writers/job.hpp

using Files = std::vector<std::filesystem::path>;

/// One output: the words that ask for it, the names of its files, and the code that writes them.
struct Writer {
  std::string name;                ///< unique in the list: "NetCDF"
  std::vector<std::string> names;  ///< shell patterns of all its files, relative to the output folder
  /// Writes the files, each aside and renamed. Returns the paths to print. Throws DataError, Interrupted.
  std::function<Files(const Job& job)> write;
  std::vector<std::string_view> words{};            ///< of [postprocess] outputs that ask for it; none: every run does
  std::function<bool(const Job& job)> asked_for{};  ///< in place of the words: whether recipe and run ask for it
  /// Throws DataError if a wanted output lacks frames, a program or space. Called before any file is written.
  std::function<void(const Job& job)> check{};
  /// Patterns of the files of an earlier run that are deleted before the first writer starts; not set: `names`. A
  /// writer whose files every run replaces has none.
  std::optional<std::vector<std::string>> outdated{};
  bool stands_alone = false;  ///< write() may run beside other writers: no HDF5, no GDAL, and it finds nothing doubtful

  /// True if the recipe asks for the output and the run has its data.
  bool wanted(const Job& job) const;
};

/// All writers in the order of writing (writers/writers.cpp).
std::vector<Writer> all_writers();

/// Words of all writers.
std::vector<std::string_view> output_words();

/// Calls check() of the wanted writers.
void check_outputs(const Job& job);

/// Deletes the outdated files under `out`, in reverse order of writing: score.json, which marks all as complete, first.
void remove_outdated_outputs(const std::filesystem::path& out);

/// Runs the wanted writers, those that stand alone beside the others, the last one at the end. Returns paths to print.
Files write_outputs(const Job& job);

/// True if a path relative to the output folder matches one of the patterns.
bool matches(const std::vector<std::string>& patterns, const std::string& path);

}  // namespace talus::postprocess
