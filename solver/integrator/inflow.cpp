// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/inflow.hpp"

#include <cstddef>

namespace talus::solver {
namespace {

/// The sum of a member over the first pulses.
template <class Value>
Value sum_of(const std::vector<InflowPulse>& pulses, std::int64_t passed, Value InflowPulse::*member) {
  Value sum{};
  for (std::int64_t n = 0; n < passed; ++n) sum += pulses[static_cast<std::size_t>(n)].*member;
  return sum;
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
    const auto begin = more.begin() + static_cast<std::ptrdiff_t>(first);
    list.insert(list.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  visit_particle_fields(append, to, from);
}

}  // namespace talus::solver
