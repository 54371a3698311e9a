// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A score while it is being filled in.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "postprocess/score/score.hpp"

namespace talus::postprocess {

/// Collects entries in sections; a number that is not finite goes to not_scored with the reason given.
class Sheet {
 public:
  explicit Sheet(std::string title) { score_.title = std::move(title); }

  /// Begins a section.
  void section(std::string title) { score_.sections.push_back({std::move(title), {}}); }
  /// Adds a word to the last section.
  void text(std::string key, std::string label, std::string value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", std::move(value), 0});
  }
  /// Adds a whole number to the last section.
  void count(std::string key, std::string label, std::int64_t value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", value, 0});
  }
  /// Adds a number with its unit and decimals; one that is not finite is not scored, for the reason `missing`.
  void number(std::string key, std::string label, std::string unit, double value, int decimals,
              const std::string& missing = "not a number") {
    if (std::isfinite(value)) {
      score_.sections.back().entries.push_back({std::move(key), std::move(label), std::move(unit), value, decimals});
    } else {
      score_.not_scored.emplace_back(std::move(key), missing);
    }
  }
  /// Says of keys that they are not scored, and why.
  void skip(std::initializer_list<const char*> keys, const std::string& why) {
    for (const auto* key : keys) score_.not_scored.emplace_back(key, why);
  }
  /// Adds a remark below the score.
  void note(std::string text) { score_.notes.push_back(std::move(text)); }
  /// The score as filled in so far; the sheet is empty then.
  Score take() { return std::move(score_); }

 private:
  Score score_;
};

}  // namespace talus::postprocess
