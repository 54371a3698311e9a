// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shaking of the ground as kernels see it: an accelerogram and its integral over time.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// A sample of an accelerogram; between samples the acceleration is linear.
struct ShakingSample {
  double time = 0;              ///< of the run [s]
  Vec3<double> acceleration{};  ///< of the ground [m/s2]
  Vec3<double> velocity{};      ///< of the ground, from rest before the first sample (T41) [m/s]
};

/// An accelerogram, its samples in the order of time. Before its first and after its last one the ground does not
/// accelerate.
struct ShakingView {
  const ShakingSample* samples = nullptr;
  int count = 0;  ///< 0, or 2 and more

  /// Whether there is an accelerogram.
  TALUS_HD bool acts() const { return count > 0; }

  /// The velocity of the ground at a time (T41) [m/s].
  TALUS_HD Vec3<double> velocity_at(double time) const {
    if (!acts() || time <= samples[0].time) return {};
    if (time >= samples[count - 1].time) return samples[count - 1].velocity;
    const int k = before(time);
    const ShakingSample a = samples[k], b = samples[k + 1];
    const double into = time - a.time, share = into / (b.time - a.time);
    return a.velocity + (a.acceleration + (b.acceleration - a.acceleration) * (0.5 * share)) * into;
  }

 private:
  TALUS_HD bool holds(int k, double time) const { return samples[k].time <= time && time < samples[k + 1].time; }

  /// The sample before a time that lies within the accelerogram. Samples are mostly equally apart: then it is found at
  /// once.
  TALUS_HD int before(double time) const {
    const double first = samples[0].time, duration = samples[count - 1].time - first;
    int low = static_cast<int>((time - first) / duration * (count - 1)), high = count - 1;
    if (low > count - 2) low = count - 2;
    if (holds(low, time)) return low;
    low = 0;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      if (samples[middle].time <= time) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return low;
  }
};

}  // namespace talus
