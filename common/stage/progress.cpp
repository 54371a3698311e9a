// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "common/stage/console.hpp"
#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

bool line_on_terminal = false;  // a progress line stands on the terminal, without its newline

std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

/// Between two lines where no terminal redraws them [s]: TALUS_PROGRESS_S, which programs set that show how far a run
/// is, or 10.
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

void clear_progress_line() {
  if (!line_on_terminal) return;
  std::fputs("\r\033[K", stderr);
  line_on_terminal = false;
}

Progress::Progress()
    : terminal_(context().logs_to_stderr() && ::isatty(STDERR_FILENO) == 1),
      quiet_(context().logs_to_stderr() && verbosity() == Verbosity::quiet) {
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
