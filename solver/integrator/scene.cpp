// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/scene.hpp"

#include <algorithm>
#include <limits>

namespace talus::solver {
namespace {

/// The sum of a member over the first pulses.
template <class Value>
Value sum_of(const std::vector<InflowPulse>& pulses, std::int64_t passed, Value InflowPulse::*member) {
  Value sum{};
  for (std::int64_t n = 0; n < passed; ++n) sum += pulses[static_cast<std::size_t>(n)].*member;
  return sum;
}

template <class Vector>
double largest(const std::vector<ShakingSample>& samples, const Vector& vector) {
  double most = 0;
  for (const ShakingSample& sample : samples) most = std::max(most, length(vector(sample)));
  return most;
}

}  // namespace

double Inflow::volume(std::int64_t passed) const { return sum_of(pulses, passed, &InflowPulse::volume); }
double Inflow::energy(std::int64_t passed) const { return sum_of(pulses, passed, &InflowPulse::energy); }
Vec3<double> Inflow::momentum(std::int64_t passed) const { return sum_of(pulses, passed, &InflowPulse::momentum); }

ParticleState Inflow::points_of(const InflowPulse& pulse) const {
  ParticleState some;
  append_points(some, points, pulse.first, pulse.count);
  return some;
}

void append_points(ParticleState& to, const ParticleState& from, std::size_t first, std::size_t count) {
  const auto append = [&](const ParticleField&, int, auto& list, const auto& more) {
    if (more.empty()) return;
    const auto begin = more.begin() + static_cast<std::ptrdiff_t>(first);
    list.insert(list.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  visit_particle_fields(append, to, from);
}

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

std::vector<Vec3<double>> load_densities(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes,
                                         double begin, double time) {
  std::vector<Vec3<double>> densities;
  for (std::size_t l = 0; l < volumes.size(); ++l) {
    const LoadOptions& load = loads[l];
    double share = begin >= load.from && begin < load.to ? 1.0 : 0.0;
    if (load.ramp > 0) share *= std::clamp((time - load.from) / load.ramp, 0.0, 1.0);
    const double scale = share / volumes[l];
    densities.push_back({load.force[0] * scale, load.force[1] * scale, load.force[2] * scale});
  }
  return densities;
}

bool loads_jump(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes, double time) {
  const auto jumps = [time](const LoadOptions& load) {
    return (time == load.from && !(load.ramp > 0)) || time == load.to;
  };
  return std::any_of(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(volumes.size()), jumps);
}

}  // namespace talus::solver
