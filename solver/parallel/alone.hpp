// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work that keeps to the thread that calls it, where others have work of their own.
#pragma once

namespace talus {

/// While it lives, loops and sums that this thread starts on a CpuDevice stay on this thread. Their results have the
/// same bits as on all threads.
class Alone {
 public:
  Alone();
  ~Alone();
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

  /// Whether the calling thread works alone.
  static bool here();

 private:
  bool before_;
};

}  // namespace talus
