// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B8: blocks on an incline whose friction is drawn from a distribution.
#include <algorithm>

#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

constexpr double gravity = 9.81;                           ///< [m/s2]
constexpr double incline = 10 * degree, start_speed = 5;   ///< [rad], [m/s]
constexpr double least_friction = 20, most_friction = 30;  ///< of the bed, uniform between them [deg]

/// The plan distance in which a rigid block comes to rest [m].
double stopping_distance(double friction_deg) {
  const double deceleration = gravity * (std::tan(friction_deg * degree) * std::cos(incline) - std::sin(incline));
  return start_speed * start_speed / (2 * deceleration) * std::cos(incline);
}

/// The share of all blocks that go no farther than `distance` in plan: those of a friction above the one that stops
/// there.
double share_within(double distance) {
  const double deceleration = start_speed * start_speed * std::cos(incline) / (2 * distance);
  const double tangent = (deceleration / gravity + std::sin(incline)) / std::cos(incline);
  return std::clamp((most_friction - std::atan(tangent) / degree) / (most_friction - least_friction), 0.0, 1.0);
}

/// Kolmogorov and Smirnov's distance between the distances of a sample and their distribution.
double distribution_distance(std::vector<double> sample) {
  std::sort(sample.begin(), sample.end());
  const auto count = static_cast<double>(sample.size());
  double apart = 0;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const double share = share_within(sample[k]), below = static_cast<double>(k) / count;
    apart = std::max({apart, std::abs(share - below), std::abs(share - below - 1 / count)});
  }
  return apart;
}

}  // namespace

void blocks_of_unknown_friction(Bench& bench) {
  const long members = bench.complete() ? 10000 : bench.coarse() ? 60 : 500;
  const MembersOutcome o =
      bench.run_members(fmt::format("{} members", members), {{"ensemble.members", whole(members)}});
  std::vector<double> distances;
  double largest = 0;
  if (o.outcome.ok()) {
    const std::vector<double>& friction = o.table.columns.front().values;
    for (std::size_t k = 0; k < friction.size(); ++k) {
      if (o.counts.states[k] != MemberState::counted) continue;
      distances.push_back(o.counts.results[k].centre_travel);
      largest = std::max(largest, std::abs(distances.back() / stopping_distance(friction[k]) - 1));
    }
  }
  bench.at_least(o.outcome, "members counted", static_cast<double>(distances.size()), static_cast<double>(members));
  // Half a per cent: the block is elastic, and stops within a wave's time.
  bench.measure(o.outcome, "largest error of a distance", largest, 0.005);
  // The bound that 99 % of all samples of a distribution keep (Kolmogorov's limit law).
  bench.measure(o.outcome, "distance of the distributions", distribution_distance(distances),
                1.628 / std::sqrt(static_cast<double>(members)));
}

}  // namespace talus::validation
