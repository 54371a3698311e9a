// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ensembles whose distributions have closed forms: blocks on an incline with an unknown friction.
#include "solver/ensemble/run_members.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

constexpr double least = 20, most = 30;  ///< friction angle of the bed, uniform between them [deg]

/// The deceleration of a rigid block along the incline [m/s2].
double deceleration(double friction_deg) {
  return gravity * (std::tan(friction_deg * degree) * std::cos(slope) - std::sin(slope));
}

/// The plan distance in which it comes to rest [m].
double distance(double friction_deg) {
  return start_speed * start_speed / (2 * deceleration(friction_deg)) * std::cos(slope);
}

/// The share of the members whose deceleration is below `a`.
double share_below(double a) {
  const double friction = std::atan((a / gravity + std::sin(slope)) / std::cos(slope)) / degree;
  return std::clamp((friction - least) / (most - least), 0.0, 1.0);
}

/// The share whose block goes no farther than `s` in plan.
double share_within(double s) { return 1 - share_below(start_speed * start_speed * std::cos(slope) / (2 * s)); }

class BlocksOnInclines : public InEachPlace {
 protected:
  static constexpr int count = 32;
  static constexpr int columns = 28, front = 10;  ///< the block's lower edge is at this column

  BlocksOnInclines() : recipe_(scratch_.write("recipe.toml", recipe_text())) {
    domain_ = ground(columns, 8, 1.0, 1.0, [](double x, double) { return 100 - std::tan(slope) * x; });
    fill(domain_, {front - 4, front, 2, 6, 0, 1});
    table_.design = "table";
    table_.count = count;
    table_.columns = {{"solve.base.friction_angle_deg", {}, {}}};
    for (int k = 0; k < count; ++k)  // the middle of every stratum
      table_.columns[0].values.push_back(least + (most - least) * (k + 0.5) / count);
    table_.own_domain.assign(count, 0);
  }

  static std::string recipe_text() {
    const double across = start_speed * std::cos(slope), down = -start_speed * std::sin(slope);
    return "[solve]\nend_time_s = 3.0\nintegrator = \"column-implicit\"\ninitial_velocity_m_s = [" +
           std::to_string(across) + ", 0.0, " + std::to_string(down) +
           "]\n[solve.material]\nmodel = \"hencky\"\nyoungs_modulus_Pa = 1e8\n"
           "[solve.base]\nlaw = \"coulomb\"\nfriction_angle_deg = 25.0\n";
  }

  EnsembleCounts counted(const ThresholdOptions& thresholds) const {
    const SolveOptions base = options_of(recipe_, scratch_.folder());
    const Members members(recipe_, table_, {scratch_.folder()}, std::make_shared<const Domain>(domain_), base);
    EnsembleScene scene;
    scene.grid = domain_.grid;
    scene.terrain = scene.before = scene.release_thickness = domain_.terrain.values;
    scene.threshold = base.map_threshold;
    EnsembleCounts counts = empty_counts(scene, count, {0, count}, thresholds);
    std::vector<AnyDevice> devices{make_device(GetParam()), make_device(GetParam())};
    run_members(members, counts, {.devices = devices});
    EXPECT_EQ(counts.count(MemberState::counted), count);
    return counts;
  }

  test::Scratch scratch_;
  recipe::Recipe recipe_;
  Domain domain_;
  MemberTable table_;
};

/// A block on points in cells of a metre follows Coulomb's law to 0.5 %: at 1e8 Pa it is 0.1 % from rigid. The members
/// are the middles of strata, so the distribution of distances may differ from the closed form by half a member and by
/// what 0.5 % of a distance is in probability: at most 0.5 % of d(share)/d(ln s) = 2.
void expect_distances(const EnsembleCounts& counts, const std::vector<double>& friction) {
  double largest = 0, apart = 0;
  std::vector<double> ways;
  for (std::size_t k = 0; k < friction.size(); ++k) {
    ways.push_back(counts.results[k].centre_travel);
    largest = std::max(largest, std::abs(ways.back() / distance(friction[k]) - 1));
  }
  std::sort(ways.begin(), ways.end());
  const auto count = static_cast<double>(ways.size());
  for (std::size_t k = 0; k < ways.size(); ++k) {  // Kolmogorov and Smirnov's distance
    const double share = share_within(ways[k]), below = static_cast<double>(k) / count;
    apart = std::max({apart, std::abs(share - below), std::abs(share - below - 1 / count)});
  }
  std::printf("  largest error of a distance %.3f %%, distance of the distributions %.4f\n", 100 * largest, apart);
  EXPECT_LT(largest, 5e-3);
  EXPECT_LT(apart, 1 / count + 0.01);
}

/// The block's front passes the middle of a cell, s from where it began, at v^2 = v0^2 - 2 a s: the probability that
/// the largest speed there is above v is that of a < (v0^2 - v^2) / 2 s. A cell's speed is the mean of its points,
/// which come by within a cell of that place.
void expect_exceedance(const EnsembleCounts& counts, int front) {
  const MapTally& speed = counts.maps[2];
  ASSERT_STREQ(counted_maps[2].name, "peak_speed");
  const auto members = static_cast<double>(counts.members);
  int between = 0;
  for (std::size_t n = 0; n < speed.thresholds.size(); ++n) {
    const double v = speed.thresholds[n];
    const auto exceeded = counts.cells.spread(speed.exceeded[n], 0u);
    const auto probability = [&](double s) {
      return s <= 0 ? 1.0 : share_below((start_speed * start_speed - v * v) / (2 * s));
    };
    for (int column = front + 1; column < counts.scene.grid.columns - 2; ++column) {
      const double s = (column + 0.5 - front) / std::cos(slope);
      const double counted = exceeded[counts.scene.grid.index(column, 4)] / members;
      EXPECT_LE(counted, probability(s - 1) + 1 / members) << v << " m/s at column " << column;
      EXPECT_GE(counted, probability(s + 1) - 1 / members) << v << " m/s at column " << column;
      between += counted > 0.1 && counted < 0.9 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 4) << "probabilities are neither 0 nor 1 somewhere";
}

TEST_P(BlocksOnInclines, go_as_far_and_as_fast_as_the_distribution_of_friction_says) {
  ThresholdOptions thresholds;
  thresholds.speed = {1, 2, 3, 4};
  const EnsembleCounts counts = counted(thresholds);
  expect_distances(counts, table_.columns[0].values);
  expect_exceedance(counts, front);
}

TALUS_IN_EACH_PLACE(BlocksOnInclines);

}  // namespace
}  // namespace talus::solver::testing
