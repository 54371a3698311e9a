// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/statistics.hpp"

#include <openturns/CorrelationAnalysis.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SaltelliSensitivityAlgorithm.hxx>

#include <cmath>

namespace talus::postprocess {
namespace {

OT::Sample sample_of(const std::vector<std::vector<double>>& columns) {
  OT::Sample sample(columns.front().size(), columns.size());
  for (std::size_t n = 0; n < columns.size(); ++n)
    for (std::size_t k = 0; k < columns[n].size(); ++k) sample(k, n) = columns[n][k];
  return sample;
}

std::vector<double> list_of(const OT::Point& point) { return {point.begin(), point.end()}; }

}  // namespace

SobolIndices sobol_indices(const std::vector<std::vector<double>>& inputs, const std::vector<double>& outputs,
                           std::size_t size) {
  OT::RandomGenerator::SetSeed(0);  // the intervals are bootstrapped: the same ones every time
  const OT::SaltelliSensitivityAlgorithm algorithm(sample_of(inputs), sample_of({outputs}), size);
  SobolIndices indices;
  indices.first = list_of(algorithm.getFirstOrderIndices());
  indices.total = list_of(algorithm.getTotalOrderIndices());
  const OT::Interval first = algorithm.getFirstOrderIndicesInterval(), total = algorithm.getTotalOrderIndicesInterval();
  indices.first_low = list_of(first.getLowerBound());
  indices.first_high = list_of(first.getUpperBound());
  indices.total_low = list_of(total.getLowerBound());
  indices.total_high = list_of(total.getUpperBound());
  return indices;
}

std::vector<double> rank_correlations(const std::vector<std::vector<double>>& inputs,
                                      const std::vector<double>& outputs) {
  return list_of(OT::CorrelationAnalysis(sample_of(inputs), sample_of({outputs})).computeSpearmanCorrelation());
}

std::vector<double> rank_regression(const std::vector<std::vector<double>>& inputs,
                                    const std::vector<double>& outputs) {
  try {
    auto found = list_of(OT::CorrelationAnalysis(sample_of(inputs), sample_of({outputs})).computeSRRC());
    for (const double value : found)
      if (!std::isfinite(value)) return {};
    return found;
  } catch (const OT::Exception&) {
    return {};
  }
}

}  // namespace talus::postprocess
