// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/medoids.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/stage/in_threads.hpp"

namespace talus::postprocess {
namespace {

/// Distances of every two of the members that are looked at.
class Distances {
 public:
  Distances(const EnsembleCounts& counts, const std::vector<std::int64_t>& members) : count_(members.size()) {
    values_.assign(count_ * count_, 0.0);
    in_threads(count_, "comparing the footprints", [&](std::size_t a) {
      for (std::size_t b = a + 1; b < count_; ++b)
        values_[a * count_ + b] = values_[b * count_ + a] = jaccard_distance(
            counts.flow[static_cast<std::size_t>(members[a])], counts.flow[static_cast<std::size_t>(members[b])]);
    });
  }
  std::size_t count() const { return count_; }
  double operator()(std::size_t a, std::size_t b) const { return values_[a * count_ + b]; }

  /// The nearest of some, and the sum of all distances from their nearest.
  std::size_t nearest(std::size_t a, const std::vector<std::size_t>& some) const {
    return *std::min_element(some.begin(), some.end(),
                             [&](std::size_t one, std::size_t other) { return (*this)(a, one) < (*this)(a, other); });
  }
  double cost(const std::vector<std::size_t>& some) const {
    double sum = 0;
    for (std::size_t a = 0; a < count_; ++a) sum += (*this)(a, nearest(a, some));
    return sum;
  }

 private:
  std::size_t count_;
  std::vector<double> values_;
};

/// Adds the one that lowers the cost most.
bool build(const Distances& distances, std::vector<std::size_t>& chosen) {
  double best = chosen.empty() ? std::numeric_limits<double>::infinity() : distances.cost(chosen);
  std::size_t found = distances.count();
  for (std::size_t a = 0; a < distances.count(); ++a) {
    chosen.push_back(a);
    if (const double cost = distances.cost(chosen); cost < best - 1e-12) {
      best = cost;
      found = a;
    }
    chosen.pop_back();
  }
  if (found < distances.count()) chosen.push_back(found);
  return found < distances.count();
}

/// Puts another in the place of one where that lowers the cost, once over all pairs.
bool swap(const Distances& distances, std::vector<std::size_t>& chosen) {
  bool better = false;
  double best = distances.cost(chosen);
  for (std::size_t& place : chosen)
    for (std::size_t a = 0; a < distances.count(); ++a) {
      const std::size_t before = std::exchange(place, a);
      const double cost = distances.cost(chosen);
      if (cost < best - 1e-12) {
        best = cost;
        better = true;
      } else {
        place = before;
      }
    }
  return better;
}

}  // namespace

double jaccard_distance(const Footprint& a, const Footprint& b) {
  std::int64_t common = 0, either = 0;
  std::size_t at_a = 0, at_b = 0;
  std::int64_t left_a = a.empty() ? 0 : a[0], left_b = b.empty() ? 0 : b[0];
  while (at_a < a.size() && at_b < b.size()) {
    const std::int64_t step = std::min(left_a, left_b);
    const bool in_a = at_a % 2 == 1, in_b = at_b % 2 == 1;
    if (in_a && in_b) common += step;
    if (in_a || in_b) either += step;
    left_a -= step;
    left_b -= step;
    if (left_a == 0 && ++at_a < a.size()) left_a = a[at_a];
    if (left_b == 0 && ++at_b < b.size()) left_b = b[at_b];
  }
  return either > 0 ? 1 - static_cast<double>(common) / static_cast<double>(either) : 0;
}

Medoids medoids(const EnsembleCounts& counts, std::size_t wanted, std::size_t most) {
  constexpr int most_rounds = 20;
  std::vector<std::int64_t> members;
  for (std::size_t k = 0; k < counts.states.size() && members.size() < most; ++k)
    if (counts.states[k] == MemberState::counted) members.push_back(static_cast<std::int64_t>(k));
  const Distances distances(counts, members);
  std::vector<std::size_t> chosen;
  while (chosen.size() < wanted && build(distances, chosen)) {
  }
  for (int round = 0; round < most_rounds && swap(distances, chosen); ++round) {
  }
  Medoids found;
  found.represented_by.assign(counts.states.size(), -1);
  std::vector<std::int64_t> sizes(members.size(), 0);
  for (std::size_t a = 0; a < members.size() && !chosen.empty(); ++a) {
    const std::size_t medoid = distances.nearest(a, chosen);
    ++sizes[medoid];
    found.represented_by[static_cast<std::size_t>(members[a])] = members[medoid];
  }
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  for (const std::size_t medoid : chosen) {
    found.members.push_back(members[medoid]);
    found.counts.push_back(sizes[medoid]);
  }
  if (!members.empty() && !chosen.empty())
    found.mean_distance = distances.cost(chosen) / static_cast<double>(members.size());
  return found;
}

}  // namespace talus::postprocess
