#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

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

void log_info(const std::string& text) {
  clear_progress_line();
  logger().info(text);
}

void log_warning(const std::string& text) {
  clear_progress_line();
  logger().warn("warning: " + text);
}

void log_detail(const std::string& text) {
  if (current == Verbosity::verbose) clear_progress_line();
  logger().debug(text);
}

void log_error(const std::string& text) {
  clear_progress_line();
  logger().error(text);
}

}  // namespace talus
