// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What this process may take of the machine: threads and memory.
#pragma once

#include <string>
#include <string_view>

namespace talus {

/// Processors that this process may run on at once: the least of its affinity mask, the limit of its control group
/// (cpu.max, rounded up) and what the machine has; at least 1.
int usable_threads();

/// Threads that the calling thread's context takes at most: what --threads gave, else usable_threads().
int thread_limit();

/// Sets the number of threads that the calling thread's context takes at most; 0 = usable_threads(). More than are
/// usable are taken as they are.
void set_thread_limit(int threads);

/// What the system says of its memory under a name of /proc/meminfo, as "MemTotal" or "MemAvailable" [bytes]. Infinity
/// where it does not.
double memory_of_machine(std::string_view name);

/// Memory that this process may have at most [bytes]: the least of the machine's, that of its control groups and its
/// own limits (ulimit -v). Infinity where nothing is known.
double usable_memory();

/// Throws DataError "what (why). mend" where `bytes` are more than usable_memory(); why says both numbers. To be called
/// before they are allocated.
void require_memory(double bytes, const std::string& what, const std::string& mend);

}  // namespace talus
