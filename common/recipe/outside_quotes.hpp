// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Letters that TOML knows in strings and comments alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace talus::recipe {

/// A place in a text: line and column, both from 1; columns are characters.
struct TextPlace {
  std::size_t line = 1, column = 1;
};

/// The first character beyond ASCII that stands neither in a string nor in a comment of a TOML text; none: there is
/// none. Version 3.3 of toml++ leaves the paths that its authors thought of at such a character, so it must not see
/// one. Up to the first fault of the text, strings begin and end here where they do in TOML.
std::optional<TextPlace> foreign_letter_outside_quotes(const std::string& text);

}  // namespace talus::recipe
