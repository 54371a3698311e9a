// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/depends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace talus {
namespace {

enum class Side { target, prerequisite };

bool make_can_write(const std::string& name) {
  return name.find_first_of(";\n\r") == std::string::npos && name.find_last_of(")&\\") != name.size() - 1;
}

/// Backslashes before a character that takes one itself count double.
void double_backslashes(std::string& text) {
  const auto rest = text.find_last_not_of('\\');
  const std::size_t count = text.size() - (rest == std::string::npos ? 0 : rest + 1);
  text.append(count, '\\');
}

/// A file name as GNU make 4 reads it. '=' would begin a variable of the target's own and '%' in a target a pattern.
std::string escaped(const std::string& name, Side side) {
  constexpr std::string_view with_backslash = " \t#:|*?[";
  std::string text;
  for (const char c : name) {
    if (with_backslash.find(c) != std::string_view::npos || (c == '%' && side == Side::target)) {
      double_backslashes(text);
      text += {'\\', c};
    } else if (c == '$') {
      text += "$$";
    } else if (c == '=') {
      text += "$(or =)";
    } else {
      text += c;
    }
  }
  return text;
}

/// The names that make can write, each once; the others go into `comments`.
std::vector<std::string> writable(const std::vector<std::filesystem::path>& paths, std::string& comments) {
  std::vector<std::string> names;
  for (const auto& path : paths) {
    const std::string& name = path.native();
    if (name.empty() || std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (make_can_write(name)) {
      names.push_back(name);
    } else {
      std::string line = name;
      std::replace_if(
          line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
      comments += fmt::format("# left out, for make has no way to write this name: {} .\n", line);
    }
  }
  return names;
}

}  // namespace

std::string make_rules(const Dependencies& depends) {
  std::string comments, rule, empty_rules;
  for (const std::string& name : writable(depends.results, comments))
    rule += (rule.empty() ? "" : " ") + escaped(name, Side::target);
  rule += ":";
  for (const std::string& name : writable(depends.inputs, comments)) {
    rule += " \\\n  " + escaped(name, Side::prerequisite);
    empty_rules += "\n" + escaped(name, Side::target) + ":\n";
  }
  return comments + rule + "\n" + empty_rules;
}

}  // namespace talus
