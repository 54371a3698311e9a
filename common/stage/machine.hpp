// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What this process may take of the machine: threads and memory; work that is shared among threads.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace talus {

/// Processors that this process may run on at once: the least of its affinity mask, the limit of its control group
/// (cpu.max, rounded up) and what the machine has; at least 1.
int usable_threads();

/// Threads that the calling thread's context takes at most: what --threads gave, else usable_threads().
int thread_limit();

/// What the system says of its memory under a name of /proc/meminfo, such as "MemTotal" [bytes]; else infinity.
double memory_of_machine(std::string_view name);

/// How long ago this process was started, before its libraries were loaded [s]; to 0.01 s.
double age_of_process();

/// Memory that this process may have at most [bytes]: the least of the machine's, that of its control groups and its
/// own limits (ulimit -v). Infinity where nothing is known.
double usable_memory();

/// Throws DataError "what (why). mend" where `bytes` to be allocated exceed usable_memory(); why: both numbers.
void require_memory(double bytes, const std::string& what, const std::string& mend);

/// Threads that write files aside at the same time, at most: a signal must find the names of all of them (doom()).
inline constexpr std::size_t most_threads_that_write = 16;

/// This function calls work(place) for each place from 0 to count - 1, in that order, on as many threads as the process
/// may have (`--threads`), at most `most`; the calling one is among them, and the others use its context. No call is
/// begun once one has thrown or the process is interrupted. When all have ended it throws what the call of the lowest
/// place threw; where a signal left places undone, Interrupted: "stopped while DOING".
void in_threads(std::size_t count, const std::string& doing, const std::function<void(std::size_t place)>& work,
                std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace talus
