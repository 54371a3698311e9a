// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Small runs that share a GPU: their kernels are started as one, since a GPU takes in a kernel of one block as slowly
// as one of a thousand.
#pragma once

#include <memory>
#include <vector>

#include "solver/parallel/any_device.hpp"
#include "solver/parallel/launch_list.hpp"

namespace talus {

/// The runs that share one GPU. Each gives in what it has to start, from a thread of its own. Whoever finds the GPU
/// idle starts what all have given in until then as one, and the others wait for their part of it.
class Together {
 public:
  /// The constructor takes the number of the GPU and the devices that share it.
  Together(int gpu, int devices);
  ~Together();
  Together(const Together&) = delete;
  Together& operator=(const Together&) = delete;

  /// The method does work with `times` steps or, where others ask for more, as many as they do, and returns when it is
  /// done. It comes after all that was started on the device, which must be of this GPU. Throws what failed.
  void run(const GpuDevice& device, const SharedWork& work, int times);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// This function lets devices of the same GPU start what they repeat (Recording) as one. Devices of a CPU, and a GPU
/// with one device, stay as they are.
void share_starts(const std::vector<AnyDevice>& devices);

}  // namespace talus
