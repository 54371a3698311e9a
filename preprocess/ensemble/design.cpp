// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/design.hpp"

#include <fmt/format.h>

#include <openturns/ComposedDistribution.hxx>
#include <openturns/GeometricProfile.hxx>
#include <openturns/LHSExperiment.hxx>
#include <openturns/LowDiscrepancyExperiment.hxx>
#include <openturns/MonteCarloExperiment.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SimulatedAnnealingLHS.hxx>
#include <openturns/SobolIndicesExperiment.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/SpaceFillingC2.hxx>
#include <openturns/TBB.hxx>
#include <openturns/Tuples.hxx>
#include <openturns/Uniform.hxx>

#include "common/error.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t most_directions = 1111;  // of Sobol's sequence in OpenTURNS
constexpr double most_improved = 2e5;          // members times keys of an optimal hypercube

[[noreturn]] void refuse_design(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError(Fault{"[ensemble]: " + what, why, mend});
}

OT::ComposedDistribution unit_cube(std::size_t keys) {
  return OT::ComposedDistribution(OT::ComposedDistribution::DistributionCollection(keys, OT::Uniform(0, 1)));
}

OT::LowDiscrepancyExperiment sobol(std::size_t keys, std::size_t count) {
  OT::LowDiscrepancyExperiment experiment(OT::SobolSequence(), unit_cube(keys), count, true);
  experiment.setRandomize(true);
  return experiment;
}

OT::Sample optimal(std::size_t keys, std::size_t count) {
  if (static_cast<double>(count * keys) > most_improved)
    refuse_design(fmt::format("design = \"optimal-latin-hypercube\" with {} members of {} keys", count, keys),
                  fmt::format("its strata are exchanged one by one; up to {:g} numbers are", most_improved),
                  "Take design = \"sobol\", which fills the space as well");
  const OT::LHSExperiment start(unit_cube(keys), count, false, true);
  return OT::SimulatedAnnealingLHS(start, OT::SpaceFillingC2(), OT::GeometricProfile()).generate();
}

OT::Sample sensitivity(std::size_t keys, std::size_t sample_size) {
  return OT::SobolIndicesExperiment(OT::WeightedExperiment(sobol(keys, sample_size)), false).generate();
}

void check_size(Design design, std::size_t members, std::size_t keys) {
  const std::size_t directions = design == Design::sensitivity ? 2 * keys : design == Design::sobol ? keys : 0;
  if (directions > most_directions)
    refuse_design(fmt::format("{} keys vary", keys), fmt::format("Sobol's sequence has {} directions", most_directions),
                  "Vary fewer, or take design = \"latin-hypercube\"");
  if (design == Design::sensitivity && members < 2 * (keys + 2))
    refuse_design(fmt::format("members = {} with design = \"sensitivity\"", members),
                  fmt::format("{} keys need at least {}", keys, 2 * (keys + 2)), "Give more");
}

OT::Sample drawn(Design design, std::size_t count, std::size_t keys) {
  switch (design) {
    case Design::latin_hypercube: return OT::LHSExperiment(unit_cube(keys), count, true, true).generate();
    case Design::optimal_hypercube: return optimal(keys, count);
    case Design::monte_carlo: return OT::MonteCarloExperiment(unit_cube(keys), count).generate();
    case Design::sensitivity: return sensitivity(keys, count);
    default: return sobol(keys, count).generate();
  }
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
  OT::TBB::Disable();  // so that the order of draws is one
  OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(seed));
  const OT::Sample sample = drawn(design, count, keys);
  for (OT::UnsignedInteger k = 0; k < sample.getSize(); ++k) {
    auto& shares = result.shares.emplace_back();
    for (OT::UnsignedInteger d = 0; d < keys; ++d) shares.push_back(std::clamp(sample(k, d), 1e-12, 1 - 1e-12));
  }
  return result;
}

std::vector<std::vector<std::size_t>> combinations(const std::vector<std::size_t>& counts, double most) {
  double all = 1;
  for (const std::size_t count : counts) all *= static_cast<double>(count);
  if (all > most)
    refuse_design(fmt::format("design = \"full-grid\" of {:.3g} members", all),
                  fmt::format("up to {:.0f} are run", most), "Give fewer levels, or vary fewer keys");
  OT::Indices sizes(counts.size());
  std::copy(counts.begin(), counts.end(), sizes.begin());
  const OT::IndicesCollection tuples(OT::Tuples(sizes).generate());
  std::vector<std::vector<std::size_t>> members;
  for (OT::UnsignedInteger k = 0; k < tuples.getSize(); ++k)
    members.emplace_back(tuples.cbegin_at(k), tuples.cend_at(k));
  return members;
}

}  // namespace talus::preprocess
