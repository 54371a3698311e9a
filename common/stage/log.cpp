// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "common/stage/console.hpp"
#include "common/stage/context.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

/// Lines on stderr, one at a time from all threads. What a context lets through is written whatever spdlog's level.
spdlog::logger& stderr_logger() {
  static const auto instance = [] {
    auto made = std::make_shared<spdlog::logger>("talus", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("%v");
    made->set_level(spdlog::level::trace);
    return made;
  }();
  return *instance;
}

const char* prefix_of(LogLevel level) {
  switch (level) {
    case LogLevel::warning: return "warning: ";
    case LogLevel::advice: return "advice: ";
    default: return "";
  }
}

void log_unless_kept_back(LogLevel level, const std::string& text) {
  if (!log_is_kept_back()) context().log(level, text);
}

}  // namespace

void write_to_stderr(LogLevel level, const std::string& text) {
  clear_progress_line();
  stderr_logger().log(level == LogLevel::error ? spdlog::level::err : spdlog::level::info, prefix_of(level) + text);
}

Verbosity verbosity() { return context().verbosity; }

void log_info(const std::string& text) { log_unless_kept_back(LogLevel::info, text); }
void log_advice(const std::string& text) { log_unless_kept_back(LogLevel::advice, text); }
void log_warning(const std::string& text) { log_unless_kept_back(LogLevel::warning, text); }
void log_detail(const std::string& text) { log_unless_kept_back(LogLevel::detail, text); }
void log_error(const std::string& text) { context().log(LogLevel::error, text); }

}  // namespace talus
