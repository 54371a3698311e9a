// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/shaking.hpp"

#include <algorithm>
#include <limits>

namespace talus::solver {
namespace {

/// The largest length of a vector of the samples.
template <class Vector>
double largest(const std::vector<ShakingSample>& samples, const Vector& vector) {
  double most = 0;
  for (const ShakingSample& sample : samples) most = std::max(most, length(vector(sample)));
  return most;
}

}  // namespace

double Shaking::next_sample(double time, double least) const {
  const auto next = std::upper_bound(samples.begin(), samples.end(), time + least,
                                     [](double t, const ShakingSample& sample) { return t < sample.time; });
  return next == samples.end() ? std::numeric_limits<double>::infinity() : next->time;
}

double Shaking::peak_acceleration() const {
  return largest(samples, [](const ShakingSample& sample) { return sample.acceleration; });
}

double Shaking::peak_velocity() const {
  return largest(samples, [](const ShakingSample& sample) { return sample.velocity; });
}

double Shaking::velocity_range() const {
  Vec3<double> low{}, high{};
  for (const ShakingSample& sample : samples) {
    const Vec3<double>& v = sample.velocity;
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return length(high - low);
}

Shaking make_shaking(const std::vector<double>& times, const std::vector<Vec3<double>>& accelerations) {
  Shaking shaking;
  shaking.samples.reserve(times.size());
  for (std::size_t n = 0; n < times.size(); ++n) {
    ShakingSample sample{.time = times[n], .acceleration = accelerations[n], .velocity = {}};
    if (n > 0) {
      const ShakingSample& last = shaking.samples.back();
      sample.velocity = last.velocity + (last.acceleration + sample.acceleration) * (0.5 * (sample.time - last.time));
    }
    shaking.samples.push_back(sample);
  }
  return shaking;
}

}  // namespace talus::solver
