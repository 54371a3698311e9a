// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Crashes of libraries on damaged files: a message that names the file, and the exit code of a data error.
#pragma once

#include <filesystem>
#include <string>

namespace talus {

/// Installs handlers of SIGSEGV, SIGBUS, SIGABRT and SIGFPE. During a WhileReading the handler prints the file with its
/// remedy and ends the process with exit code 3; otherwise the signal has its default action. `program` begins the
/// message.
void report_crashes(const std::string& program);

/// Marks a file as being read by this thread, until the end of the scope. Worker threads of a library count as well.
class WhileReading {
 public:
  WhileReading(const std::filesystem::path& file, std::string remedy);
  WhileReading(const WhileReading&) = delete;
  WhileReading& operator=(const WhileReading&) = delete;
  ~WhileReading();
  const char* file() const { return file_.c_str(); }
  const char* remedy() const { return remedy_.c_str(); }

 private:
  const WhileReading* outer_;
  std::string file_, remedy_;
};

}  // namespace talus
