// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "common/recipe/shown_paths.hpp"
#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

spdlog::logger& logger() {
  static const auto instance = [] {
    auto made = std::make_shared<spdlog::logger>("talus", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("%v");
    return made;
  }();
  return *instance;
}

Verbosity current = Verbosity::normal;
thread_local QuietThread* quiet_here = nullptr;

/// A message as it is shown: paths as the user wrote them, and no control characters, which names in files may hold and
/// a terminal would obey.
std::string shown(const std::string& text) {
  std::string plain = with_shown_paths(text);
  for (char& c : plain)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) c = '?';
  return plain;
}

}  // namespace

void set_verbosity(Verbosity verbosity) {
  current = verbosity;
  switch (verbosity) {
    case Verbosity::quiet: logger().set_level(spdlog::level::err); break;
    case Verbosity::normal: logger().set_level(spdlog::level::info); break;
    case Verbosity::verbose: logger().set_level(spdlog::level::debug); break;
  }
}

Verbosity verbosity() { return current; }

QuietThread::QuietThread() : before_(std::exchange(quiet_here, this)) {}
QuietThread::~QuietThread() { quiet_here = before_; }

void log_info(const std::string& text) {
  if (quiet_here != nullptr) return;
  clear_progress_line();
  logger().info(shown(text));
}

void log_warning(const std::string& text) {
  if (quiet_here != nullptr) return quiet_here->warnings_.push_back(text);
  clear_progress_line();
  logger().warn("warning: " + shown(text));
}

void log_detail(const std::string& text) {
  if (quiet_here != nullptr) return;
  if (current == Verbosity::verbose) clear_progress_line();
  logger().debug(shown(text));
}

void log_error(const std::string& text) {
  clear_progress_line();
  logger().error(shown(text));
}

}  // namespace talus
