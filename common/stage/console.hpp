// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much is said on stderr, and the progress line that log lines must not run into. Shared by log, progress and
// runner.
#pragma once

#include <string>

namespace talus {

enum class Verbosity { quiet, normal, verbose };

/// Of the calling thread's context (context.hpp).
Verbosity verbosity();

enum class LogLevel;
/// A line on stderr, with the prefix of its kind. Contexts without a sink of their own write by it.
void write_to_stderr(LogLevel level, const std::string& text);

/// Take a drawn progress line off the terminal, so that the next output starts on a clean line.
void clear_progress_line();

/// An error line on stderr, shown even under -q.
void log_error(const std::string& text);

}  // namespace talus
