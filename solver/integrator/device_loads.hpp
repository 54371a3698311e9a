// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The loads in the memory of a device, at one time after the other.
#pragma once

#include <utility>
#include <vector>

#include "solver/integrator/loads.hpp"
#include "solver/parallel/buffer.hpp"

namespace talus::solver {

/// The loads of a scene and the forces per volume that kernels read.
template <class Device>
class DeviceLoads {
 public:
  /// The constructor takes the loads with the volume of the particles that each pulls at [m3]; a scene whose list of
  /// volumes is empty has no loads.
  DeviceLoads(const Device& device, std::vector<LoadOptions> loads, std::vector<double> volumes)
      : loads_(std::move(loads)), volumes_(std::move(volumes)), densities_(device) {}

  /// The method uploads the force per volume of every load at a time in a step that began at `begin` [N/m3], for
  /// kernels until the next call; null when there are no loads.
  const Vec3<double>* upload(double begin, double time) {
    if (volumes_.empty()) return nullptr;
    densities_.upload(load_densities(loads_, volumes_, begin, time));
    return densities_.data();
  }
  /// Whether a load jumps at a time.
  bool jump_at(double time) const { return loads_jump(loads_, volumes_, time); }

 private:
  std::vector<LoadOptions> loads_;
  std::vector<double> volumes_;  ///< [m3]
  Buffer<Vec3<double>, Device> densities_;
};

}  // namespace talus::solver
