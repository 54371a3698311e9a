// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shaking of the ground over a run: an accelerogram, and its copy where kernels read it.
#pragma once

#include <utility>
#include <vector>

#include "solver/parallel/buffer.hpp"
#include "solver/state/shaking.hpp"

namespace talus::solver {

/// An accelerogram as a recipe asks for it, in SI units, along x, y and z of the map; empty where the ground rests.
struct Shaking {
  std::vector<ShakingSample> samples;  ///< none, or 2 and more, later and later

  /// Whether there is an accelerogram.
  bool acts() const { return !samples.empty(); }
  /// The accelerogram as it is seen on the host.
  ShakingView view() const { return {samples.data(), static_cast<int>(samples.size())}; }
  /// The end of the last sample [s]; 0 where the ground rests.
  double end() const { return acts() ? samples.back().time : 0; }
  /// The time of the first sample that is later than `time` by more than `least` [s]; infinite where there is none [s].
  double next_sample(double time, double least) const;
  /// The largest acceleration of any sample [m/s2].
  double peak_acceleration() const;
  /// The largest velocity at any sample [m/s].
  double peak_velocity() const;
  /// An upper bound of the difference between the velocities of the ground at any two samples [m/s].
  double velocity_range() const;
};

/// This function makes samples of accelerations: it adds the velocities of the ground (T41).
Shaking make_shaking(const std::vector<double>& times, const std::vector<Vec3<double>>& accelerations);

/// The shaking of a run on a device.
template <class Device>
class DeviceShaking {
 public:
  DeviceShaking(const Device& device, Shaking shaking) : shaking_(std::move(shaking)), samples_(device) {
    samples_.upload(shaking_.samples);
  }
  /// The shaking as kernels see it.
  ShakingView view() const { return {samples_.data(), static_cast<int>(samples_.size())}; }
  /// The shaking on the host.
  const Shaking& host() const { return shaking_; }
  /// The memory taken [bytes].
  std::size_t bytes() const { return samples_.bytes(); }

 private:
  Shaking shaking_;
  Buffer<ShakingSample, Device> samples_;
};

}  // namespace talus::solver
