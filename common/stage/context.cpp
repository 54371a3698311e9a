// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/context.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "common/stage/findings.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

thread_local Context* bound_here = nullptr;

bool line_on_terminal = false;  // a progress line stands on the terminal, without its newline

/// Control characters may stand in names of files, and a terminal would obey them.
std::string without_control_characters(std::string text) {
  for (char& c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) c = '?';
  return text;
}

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

std::string line_of(LogLevel level, const std::string& text) {
  return (level == LogLevel::warning ? "warning: " : level == LogLevel::advice ? "advice: " : "") + text;
}

void write_to_stderr(LogLevel level, const std::string& text) {
  clear_progress_line();
  stderr_logger().log(level == LogLevel::error ? spdlog::level::err : spdlog::level::info, line_of(level, text));
}

void log_unless_kept_back(LogLevel level, const std::string& text) {
  if (!log_is_kept_back()) context().log(level, text);
}

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

/// Between two lines where no terminal redraws them [s]: TALUS_PROGRESS_S of programs that show progress, or 10.
double between_lines() {
  const char* const text = std::getenv("TALUS_PROGRESS_S");
  if (text == nullptr || *text == '\0') return 10;
  char* end = nullptr;
  const double seconds = std::strtod(text, &end);
  if (*end == '\0' && std::isfinite(seconds) && seconds > 0) return seconds;
  static const bool said = [text] {
    log_warning("TALUS_PROGRESS_S = " + std::string(text) + " is no time in seconds; progress is said every 10 s");
    return true;
  }();
  return said ? 10 : 0;
}

}  // namespace

Context& context() {
  // Never destroyed: threads to which no context is bound may outlive main().
  static Context* const of_other_threads = [] {
    auto* made = new Context;
    made->heed_signals();
    made->paths_ = &shown_paths_of_other_threads();
    return made;
  }();
  return bound_here != nullptr ? *bound_here : *of_other_threads;
}

BindContext::BindContext(Context& bound) : previous_(std::exchange(bound_here, &bound)), paths_(bound.paths()) {}
BindContext::~BindContext() { bound_here = previous_; }

RedirectLog::RedirectLog(LogSink sink)
    : context_(context()), previous_(std::exchange(context_.redirect_, std::move(sink))) {}
RedirectLog::~RedirectLog() { context_.redirect_ = std::move(previous_); }

bool Context::is_interrupted() const { return interrupted_ || (heeds_signals_ && signal_came()); }

bool Context::logs_to_terminal() const { return logs_to_stderr() && ::isatty(STDERR_FILENO) == 1; }

void Context::start_record() {
  const std::lock_guard lock(mutex_);
  recorded_since_ = std::chrono::steady_clock::now();
  record_.clear();
}

std::string Context::end_record() {
  const std::lock_guard lock(mutex_);
  recorded_since_.reset();
  return std::exchange(record_, {});
}

bool Context::shows(LogLevel level) const {
  if (level == LogLevel::detail && verbosity != Verbosity::verbose) return false;
  if (redirect_) return true;
  if (verbosity == Verbosity::quiet) return level == LogLevel::error;
  return verbosity != Verbosity::brief || level != LogLevel::info;
}

void Context::log(LogLevel level, const std::string& text) {
  const std::string shown =
      without_control_characters(level == LogLevel::progress ? text : with_short_numbers(paths_->in_message(text)));
  const LogSink& sink = redirect_ ? redirect_ : sink_;
  if (!sink && shows(level)) write_to_stderr(level, shown);
  const std::lock_guard lock(mutex_);
  if (sink && shows(level)) sink(level, shown);
  if (!recorded_since_ || level == LogLevel::progress) return;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - *recorded_since_;
  record_ += fmt::format("{:8.1f} s  {}\n", since.count(), line_of(level, shown));
}

void Context::note_checksum(const std::filesystem::path& file, std::string digest) {
  const std::lock_guard lock(mutex_);
  checksums_[file] = std::move(digest);
}

std::string Context::checksum_of(const std::filesystem::path& file) const {
  const std::lock_guard lock(mutex_);
  const auto found = checksums_.find(file);
  return found == checksums_.end() ? "" : found->second;
}

void Context::add_lock(const std::filesystem::path& file, bool held) {
  const std::lock_guard lock(mutex_);
  locks_.push_back({file, held});
}

void Context::remove_lock(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  std::erase_if(locks_, [&](const Lock& one) { return one.file == file; });
}

bool Context::has_locked(const std::filesystem::path& folder) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(locks_.begin(), locks_.end(), [&](const Lock& one) { return one.file.parent_path() == folder; });
}

bool Context::holds_a_lock() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(locks_.begin(), locks_.end(), [](const Lock& one) { return one.held; });
}

void log_info(const std::string& text) { log_unless_kept_back(LogLevel::info, text); }
void log_advice(const std::string& text) { log_unless_kept_back(LogLevel::advice, text); }
void log_warning(const std::string& text) { log_unless_kept_back(LogLevel::warning, text); }
void log_detail(const std::string& text) { log_unless_kept_back(LogLevel::detail, text); }
void log_error(const std::string& text) { context().log(LogLevel::error, text); }

void clear_progress_line() {
  if (!line_on_terminal) return;
  std::fputs("\r\033[K", stderr);
  line_on_terminal = false;
}

Progress::Progress()
    : terminal_(context().logs_to_terminal()),
      quiet_(context().logs_to_stderr() && context().verbosity == Verbosity::quiet) {
  last_ = std::chrono::steady_clock::now();
}

Progress::~Progress() {
  if (!drawn_ || !line_on_terminal) return;
  std::fputc('\n', stderr);
  line_on_terminal = false;
}

bool Progress::due() const {
  using namespace std::chrono_literals;
  const auto since = std::chrono::steady_clock::now() - last_;
  return !quiet_ && (terminal_ ? since >= 200ms : since >= std::chrono::duration<double>(between_lines()));
}

void Progress::update(const std::string& text) {
  if (quiet_) return;
  last_ = std::chrono::steady_clock::now();
  if (terminal_) {
    std::fprintf(stderr, "\r%s\033[K",
                 text.substr(0, terminal_width()).c_str());  // a wrapped line could not be redrawn
    line_on_terminal = drawn_ = true;
  } else if (!context().logs_to_stderr()) {
    return context().log(LogLevel::progress, text);
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
  std::fflush(stderr);
}

}  // namespace talus
