// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of work that do not need one another, shared among threads.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>

namespace talus {

/// Threads that write files aside at the same time, at most: a signal must find the names of all of them (doom()).
inline constexpr std::size_t most_threads_that_write = 16;

/// This function calls work(place) for each place from 0 to count - 1, in that order, on as many threads as the process
/// may have (`--threads`), at most `most`; the calling one is among them, and the others use its context. No call is
/// begun once one has thrown or the process is interrupted. When all have ended it throws what the call of the lowest
/// place threw; where a signal left places undone, Interrupted: "stopped while DOING".
void in_threads(std::size_t count, const std::string& doing, const std::function<void(std::size_t place)>& work,
                std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace talus
