// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Paths in messages as the user wrote them, though files are opened by their absolute ones, and layers of vector files
// in one text.
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
  /// `in_report`, which should be relative to the recipe; empty: the folder is left out. The longest fit counts.
  void show_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report);
  std::string in_message(const std::string& text) const;  ///< a text with the paths as messages show them
  std::string in_report(const std::string& text) const;   ///< a text with the paths as the report shows them

 private:
  struct Shown {
    std::string path, message, report;
  };
  std::string replaced(const std::string& text, std::string Shown::*shown) const;

  mutable std::mutex mutex_;
  std::vector<Shown> known_;  ///< the longest path first
};

/// The names that the calling thread uses: of its context. Threads without a context (context.hpp) share one object.
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

/// Throws RecipeError where a path is no UTF-8: results record paths.
void refuse_name_beyond_utf8(const std::filesystem::path& path);

/// "slides.gpkg|layername=release|subset=id = 12"; layer and condition may be left out.
struct VectorSource {
  std::filesystem::path file;
  std::string layer = {};  ///< of the file; empty: not named
  std::string where = {};  ///< condition on attributes, as OGR takes it (`"fid" = 12`); empty: all features

  std::filesystem::path text() const;  ///< the text of it
};

/// The parts of such a text. That of any other path is a file alone.
VectorSource vector_source(const std::filesystem::path& text);

}  // namespace talus
