// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Paths in messages as the user wrote them, though files are opened by their absolute ones.
#pragma once

#include <filesystem>
#include <string>

namespace talus {

/// From now on messages call what lies at (or below) the absolute path `path` by `shown`, and the report by
/// `in_report`, which should be relative to the recipe; empty: the folder itself is left out. The longest path that
/// fits counts.
void show_path_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report);

/// Forgets all of that (for tests).
void forget_shown_paths();

/// A message with its paths as they are shown.
std::string with_shown_paths(const std::string& text);

/// A text of the report: paths relative to the recipe, and of absolute ones that are not known the last name alone,
/// behind an ellipsis, so that a page which is sent on tells nothing of the folders of a machine.
std::string without_absolute_paths(const std::string& text);

}  // namespace talus
