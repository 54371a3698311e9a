// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said while the same is done many times over, kept to be told once.
#pragma once

#include <string>
#include <vector>

namespace talus {

/// As long as it lives, what its thread logs is kept: warnings here, information and details nowhere. Captures may
/// stand within one another.
class LogCapture {
 public:
  LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  ~LogCapture();

  /// The warnings so far, as they would have been shown.
  std::vector<std::string> warnings;

 private:
  LogCapture* outer_;
};

}  // namespace talus
