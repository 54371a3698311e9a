// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/make_rules.hpp"

#include <algorithm>
#include <string_view>

namespace talus::command {
namespace {

/// Goes over the names of a rule.
class Names {
 public:
  explicit Names(std::string_view text) : text_(text) {}

  /// The next name; empty at the end of the rule. `last_target` turns true behind the name that the rule's colon
  /// follows.
  std::string next(bool& last_target) {
    skip_spaces();
    std::string name;
    while (at_ < text_.size() && text_[at_] != ' ' && text_[at_] != '\n') {
      if (text_[at_] == ':') {
        ++at_;
        last_target = true;
        if (!name.empty()) return name;
        skip_spaces();
      } else if (!is_line_joint()) {
        name += letter();
      } else {
        break;
      }
    }
    return name;
  }

 private:
  bool is_line_joint() const { return text_.substr(at_, 2) == "\\\n"; }
  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || is_line_joint())) at_ += text_[at_] == ' ' ? 1U : 2U;
  }

  /// A character of a name, with the backslashes before it, as it was before make's escapes.
  std::string letter() {
    if (text_.substr(at_, 2) == "$$") return at_ += 2, "$";
    if (constexpr std::string_view equals = "$(or =)"; text_.substr(at_, equals.size()) == equals)
      return at_ += equals.size(), "=";
    std::size_t backslashes = 0;
    while (at_ + backslashes < text_.size() && text_[at_ + backslashes] == '\\') ++backslashes;
    if (backslashes == 0) return std::string(1, text_[at_++]);
    const char after = at_ + backslashes < text_.size() ? text_[at_ + backslashes] : '\0';
    constexpr std::string_view with_backslash = " \t#:|*?[%";
    const bool escaped = after != '\0' && with_backslash.find(after) != std::string_view::npos && backslashes % 2 == 1;
    at_ += backslashes + (escaped ? 1 : 0);
    return std::string(escaped ? backslashes / 2 : backslashes, '\\') + (escaped ? std::string(1, after) : "");
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Dependencies read_make_rules(const std::string& text) {
  std::string_view rest = text;
  while (rest.starts_with('#')) rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
  Dependencies depends;
  Names names(rest);
  bool targets_end = false;
  for (bool is_input = false;; is_input = targets_end) {
    std::string name = names.next(targets_end);
    if (name.empty()) return depends;
    (is_input ? depends.inputs : depends.results).emplace_back(std::move(name));
  }
}

}  // namespace talus::command
