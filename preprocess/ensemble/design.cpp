// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/design.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/ensemble/openturns.hpp"
#include "common/error.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t most_directions = 1111;  // of Sobol's sequence in OpenTURNS
constexpr double most_improved = 2e5;          // members times keys of an optimal hypercube

[[noreturn]] void refuse_design(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError(Fault{"[ensemble]: " + what, why, mend});
}

void check_size(Design design, std::size_t members, std::size_t keys) {
  const std::size_t directions = design == Design::sensitivity ? 2 * keys : design == Design::sobol ? keys : 0;
  if (directions > most_directions)
    refuse_design(fmt::format("{} keys vary", keys), fmt::format("Sobol's sequence has {} directions", most_directions),
                  "Vary fewer, or take design = \"latin-hypercube\"");
  if (design == Design::sensitivity && members < 2 * (keys + 2))
    refuse_design(fmt::format("members = {} with design = \"sensitivity\"", members),
                  fmt::format("{} keys need at least {}", keys, 2 * (keys + 2)), "Give more");
  if (design == Design::optimal_hypercube && static_cast<double>(members * keys) > most_improved)
    refuse_design(fmt::format("design = \"optimal-latin-hypercube\" with {} members of {} keys", members, keys),
                  fmt::format("its strata are exchanged one by one; up to {:g} numbers are", most_improved),
                  "Take design = \"sobol\", which fills the space as well");
}

}  // namespace

UnitDesign unit_design(Design design, int members, std::size_t keys, int seed) {
  UnitDesign result;
  auto count = static_cast<std::size_t>(members);
  check_size(design, count, keys);
  if (keys == 0) {
    result.shares.resize(count);
    return result;
  }
  if (design == Design::sensitivity) {
    count /= keys + 2;
    result.sample_size = static_cast<std::int64_t>(count);
  }
  result.shares = openturns::library().draw(design, count, keys, static_cast<unsigned long>(seed));
  for (auto& shares : result.shares)
    for (double& share : shares) share = std::clamp(share, 1e-12, 1 - 1e-12);
  return result;
}

std::vector<std::vector<std::size_t>> combinations(const std::vector<std::size_t>& counts, double most) {
  double all = 1;
  for (const std::size_t count : counts) all *= static_cast<double>(count);
  if (all > most)
    refuse_design(fmt::format("design = \"full-grid\" of {:.3g} members", all),
                  fmt::format("up to {:.0f} are run", most), "Give fewer levels, or vary fewer keys");
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(all));
  for (std::size_t n = 0; n < members.size(); ++n) {  // the first key changes fastest
    std::size_t left = n;
    for (const std::size_t count : counts) {
      members[n].push_back(left % count);
      left /= count;
    }
  }
  return members;
}

}  // namespace talus::preprocess
