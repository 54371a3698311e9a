// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a file in a process of its own, so that a broken one on which a library crashes or hangs ends in an error.
//
// The process is this program started anew, with posix_spawn: nothing of the parent's memory is copied, none of its
// threads, locks and GPU contexts are inherited, and the child makes no context of its own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace talus {

/// A reading that can be done by a process of its own: from the words it was asked with to bytes. It may throw.
using ChildReading = std::function<std::string(const std::vector<std::string>& words)>;

/// Makes a reading known by a name. Objects of it stand in the sources that ask for the reading.
class KnownChildReading {
 public:
  KnownChildReading(const char* name, ChildReading reading);
};

/// The first call of a main(): where this process was started for a reading, it reads, answers and ends. Otherwise
/// readings are done by processes of their own from now on; without this call they are done by the process itself.
void serve_child_reading(int argc, char** argv);

/// The work to be done by a child, and what to say when it fails.
struct ChildTask {
  std::string name;                ///< of the reading
  std::vector<std::string> words;  ///< what it needs to know
  std::filesystem::path file;      ///< what it reads; its size sets the limits of time and memory
  std::string mend;                ///< of a fault
};

/// The bytes that a reading gave. Throws its DataError; one that says so where the library that reads the file crashed
/// (signal), took too long or too much memory; Interrupted where Ctrl-C came meanwhile.
std::string read_in_child(const ChildTask& task);

}  // namespace talus
