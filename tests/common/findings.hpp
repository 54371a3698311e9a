// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a function finds, for tests.
#pragma once

#include <string>
#include <vector>

#include "common/stage/findings.hpp"

namespace talus::test {

/// The findings of `work` in a stage that accepts these names. Nothing is logged. Throws DataError of what it refuses.
template <class Work>
std::vector<Finding> findings_of(const Work& work, std::vector<std::string> accept = {}, const char* stage = "solve") {
  Findings found(stage, std::move(accept), Findings::Log::kept_back);
  found.settled(work);
  return found.list();
}

/// Their messages.
template <class Work>
std::vector<std::string> messages_of(const Work& work, std::vector<std::string> accept = {}) {
  std::vector<std::string> messages;
  for (const Finding& finding : findings_of(work, std::move(accept))) messages.push_back(finding.message);
  return messages;
}

/// A finding of a stage before.
inline Finding finding(Severity severity, const char* name, const char* message) {
  return {severity, name, message, {}, "preprocess", severity == Severity::refusal ? "accept in [preprocess]" : ""};
}

}  // namespace talus::test
