// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/recipe/shown_paths.hpp"
#include "common/stage/stage.hpp"

namespace talus {

namespace {

constexpr const char *prefix = "accepted.", *opening = "accepted, ";

}  // namespace

void Acceptance::judge(const Implausible& finding) {
  const auto& [name, fault] = finding;
  if (std::find(names_.begin(), names_.end(), name) == names_.end()) {
    refused_.push_back({fault.what, fault.why,
                        fmt::format("{}. To insist on it: accept = [\"{}\"] in [{}]", fault.mend, name, table_)});
    if (!collecting_) settle();
    return;
  }
  const std::string words = with_shown_paths(fmt::format("{} ({})", fault.what, fault.why)), key = prefix + name;
  const auto known = [&](const auto& fact) { return fact.first == key; };
  if (std::any_of(facts_.begin(), facts_.end(), known)) return;
  log_warning(accepted_warning(name, words));
  facts_.emplace_back(key, words);
}

void Acceptance::settle() {
  if (!refused_.empty()) throw DataError(std::exchange(refused_, {}));
}

void Acceptance::warn_of_unmet(const std::vector<std::pair<std::string, std::string>>& others) const {
  for (const std::string& name : names_) {
    const auto met = [&](const auto& fact) { return fact.first == prefix + name; };
    if (std::none_of(facts_.begin(), facts_.end(), met) && std::none_of(others.begin(), others.end(), met))
      log_warning(
          fmt::format("[{}]: accept = [\"{}\"]: there was nothing of the kind to accept; leave it out, so that "
                      "it is refused should it come",
                      table_, name));
  }
}

std::string accepted_warning(const std::string& name, const std::string& words) {
  return fmt::format("{}\"{}\": {}", opening, name, words);
}

std::vector<std::string> without_accepted(std::vector<std::string> warnings) {
  std::erase_if(warnings, [](const std::string& words) { return words.starts_with(opening); });
  return warnings;
}

std::string accepted_fact(const std::string& name) { return prefix + name; }

std::string accepted_line(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string text;
  for (const auto& [name, words] : accepted_in(facts))
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name, words);
  return text;
}

std::vector<std::pair<std::string, std::string>> accepted_in(
    const std::vector<std::pair<std::string, std::string>>& facts) {
  std::vector<std::pair<std::string, std::string>> accepted;
  for (const auto& [key, words] : facts) {
    if (key.starts_with(prefix)) accepted.emplace_back(key.substr(std::string(prefix).size()), words);
  }
  return accepted;
}

}  // namespace talus
