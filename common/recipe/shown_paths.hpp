// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Paths in messages as the user wrote them, though files are opened by their absolute ones.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace talus {

/// The names of paths in messages and in the report. Threads may call all methods at the same time.
class ShownPaths {
 public:
  /// From now on messages call what lies at (or below) the absolute path `path` by `shown`, and the report by
  /// `in_report`, which should be relative to the recipe; empty: the folder itself is left out. The longest path that
  /// fits counts.
  void show_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report);
  /// A text with the paths as messages show them.
  std::string in_message(const std::string& text) const;
  /// A text with the paths as the report shows them.
  std::string in_report(const std::string& text) const;

 private:
  struct Shown {
    std::string path, message, report;
  };
  std::string replaced(const std::string& text, std::string Shown::*shown) const;

  mutable std::mutex mutex_;
  std::vector<Shown> known_;  ///< the longest path first
};

/// The names that the calling thread uses: those of its context (common/stage/context.hpp). Threads without a context
/// share one object.
ShownPaths& shown_paths();
ShownPaths& shown_paths_of_other_threads();

/// The calling thread uses these names while the object lives.
class BindShownPaths {
 public:
  explicit BindShownPaths(ShownPaths& paths);
  ~BindShownPaths();
  BindShownPaths(const BindShownPaths&) = delete;
  BindShownPaths& operator=(const BindShownPaths&) = delete;

 private:
  ShownPaths* previous_;
};

/// shown_paths().show_as()
void show_path_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report);

/// A message with its paths as they are shown.
std::string with_shown_paths(const std::string& text);

/// A text of the report: paths relative to the recipe, and of absolute ones that are not known the last name alone,
/// behind an ellipsis, so that a page which is sent on tells nothing of the folders of a machine.
std::string without_absolute_paths(const std::string& text);

}  // namespace talus
