// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of a run in the memory of a device, with a copy on the host.
#pragma once

#include <cstddef>

#include "solver/parallel/buffer.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/state/clock.hpp"

namespace talus::solver {

/// A clock that host and kernels change in turns. Between steps the host asks for it several times; it is copied only
/// once kernels have had it, or the host has changed it.
template <class Device>
class DeviceClock {
 public:
  DeviceClock(const Device& device, const Clock& start) : host_(start), memory_(device), room_(device) {
    memory_.upload({host_});
  }

  /// The clock as it is; waits for the device where kernels have had it.
  Clock read() const {
    if (with_kernels_) host_ = lent_ ? lent() : memory_.download().front();
    with_kernels_ = lent_ = false;
    return host_;
  }
  /// The method sets the clock.
  void write(const Clock& clock) {
    host_ = clock;
    with_kernels_ = false;
    written_ = true;
  }
  /// The method hands the clock to the kernels that are started from here on, which may change it.
  void hand_over() {
    if (written_) memory_.upload({host_});
    written_ = false;
    with_kernels_ = true;
  }
  /// The method hands the clock over to kernels between those of pass_in() and pass_out(), which are started for it:
  /// no copy by the host is needed.
  void lend() {
    *room_ = host_;
    written_ = false;
    with_kernels_ = lent_ = true;
  }
  /// The method starts the kernel that brings what was lent to kernels.
  void pass_in() { room_.copy_to(memory_.data()); }
  /// The method starts the kernel that brings it back.
  void pass_out() { room_.copy_from(memory_.data()); }
  /// The clock for kernels, after hand_over(); always at the same address.
  Clock* data() { return memory_.data(); }

 private:
  Clock lent() const {
    synchronise(memory_.device());
    return *room_;
  }
  mutable Clock host_;
  mutable bool with_kernels_ = false;  ///< the copy on the host may be an old one
  mutable bool lent_ = false;          ///< and the room is to hold a new one
  bool written_ = false;               ///< the copy on the device is an old one
  Buffer<Clock, Device> memory_;
  HostRoom<Clock, Device> room_;
};

}  // namespace talus::solver
