// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The node buffers of an implicit step.
#pragma once

#include "solver/implicit/node_arrays.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus::solver {

/// The buffers over the stored nodes, sized together; see NodeArrays for what they hold.
template <class Device>
struct NodeFields {
  explicit NodeFields(const Device& on) : device(on) {}

  Device device;
  int count = 0;
  Buffer<double, Device> mass{device};
  NodeVector<Device> velocity{device}, arrival{device}, acceleration{device}, external{device}, internal{device},
      u{device}, residual{device};
  NodeVector<Device> velocity_end{device}, acceleration_end{device};  ///< of the step
  NodeVector<Device> change{device};                                  ///< of u, from the linear system
  NodeVector<Device> saved_u{device};                                 ///< where a line search begins
  NodeVector<Device> ahead{device};  ///< the way that the nodes are about to go, where a step is one linear solve [m]
  Buffer<Sym3<double>, Device> freed{device};
  Buffer<Touch, Device> touch{device};

  /// The method makes room for so many nodes; what is summed from the points begins at zero.
  void resize(int nodes) {
    count = nodes;
    const auto n = static_cast<std::size_t>(nodes);
    mass.resize(n);
    mass.fill_zero();
    for (auto* v : {&velocity, &arrival, &acceleration, &external}) {
      v->resize(n);
      v->fill_zero();
    }
    for (auto* v : {&internal, &u, &residual, &velocity_end, &acceleration_end, &change, &saved_u, &ahead})
      v->resize(n);
    freed.resize(n);
    touch.resize(n);
  }

  /// The buffers as kernels see them; statics knows neither arrival nor acceleration.
  NodeArrays arrays(bool dynamic) {
    return {.mass = mass.data(),
            .velocity = velocity.data(),
            .arrival = dynamic ? arrival.data() : nullptr,
            .acceleration = dynamic ? acceleration.data() : nullptr,
            .external = external.data(),
            .internal = internal.data(),
            .u = u.data(),
            .residual = residual.data(),
            .freed = freed.data(),
            .touch = touch.data()};
  }

  /// The size of the buffers [bytes].
  std::size_t bytes() const {
    std::size_t total = mass.bytes() + freed.bytes() + touch.bytes();
    for (const auto* v : {&velocity, &arrival, &acceleration, &external, &internal, &u, &residual, &velocity_end,
                          &acceleration_end, &change, &saved_u, &ahead})
      total += v->bytes();
    return total;
  }
};

}  // namespace talus::solver
