// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// libtalus-openturns.so. It holds nothing of Talus but this file, so that no global of it is there twice.
#include <cmath>
#include <exception>
#include <functional>
#include <openturns/BetaMuSigma.hxx>
#include <openturns/Cobyla.hxx>
#include <openturns/ComposedDistribution.hxx>
#include <openturns/CorrelationAnalysis.hxx>
#include <openturns/CorrelationMatrix.hxx>
#include <openturns/EvaluationImplementation.hxx>
#include <openturns/GeometricProfile.hxx>
#include <openturns/HSICEstimatorGlobalSensitivity.hxx>
#include <openturns/HSICUStat.hxx>
#include <openturns/LHSExperiment.hxx>
#include <openturns/LogNormalMuSigma.hxx>
#include <openturns/LowDiscrepancyExperiment.hxx>
#include <openturns/Mixture.hxx>
#include <openturns/MonteCarloExperiment.hxx>
#include <openturns/Normal.hxx>
#include <openturns/NormalCopula.hxx>
#include <openturns/OptimizationProblem.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SaltelliSensitivityAlgorithm.hxx>
#include <openturns/SimulatedAnnealingLHS.hxx>
#include <openturns/SobolIndicesExperiment.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/SpaceFillingC2.hxx>
#include <openturns/SquaredExponential.hxx>
#include <openturns/TBB.hxx>
#include <openturns/Triangular.hxx>
#include <openturns/TruncatedDistribution.hxx>
#include <openturns/Uniform.hxx>
#include <openturns/UserDefined.hxx>
#include <utility>

#include "common/ensemble/openturns.hpp"

namespace talus::openturns {
namespace {

OT::Point point_of(const std::vector<double>& values) {
  OT::Point point(values.size());
  std::copy(values.begin(), values.end(), point.begin());
  return point;
}

std::vector<double> list_of(const OT::Point& point) { return {point.begin(), point.end()}; }

OT::Sample sample_of(const Lists& columns) {
  OT::Sample sample(columns.front().size(), columns.size());
  for (std::size_t n = 0; n < columns.size(); ++n)
    for (std::size_t k = 0; k < columns[n].size(); ++k) sample(k, n) = columns[n][k];
  return sample;
}

class OneLaw : public Law {
 public:
  explicit OneLaw(OT::Distribution distribution) : distribution_(std::move(distribution)) {}
  double below(double value) const override { return distribution_.computeCDF(value); }
  double density(double value) const override { return distribution_.computePDF(value); }
  double quantile(double share) const override { return distribution_.computeQuantile(share)[0]; }
  double mean() const override { return distribution_.getMean()[0]; }
  double deviation() const override { return distribution_.getStandardDeviation()[0]; }
  AnyLaw between(std::optional<double> low, std::optional<double> high) const override {
    using Cut = OT::TruncatedDistribution;
    if (low && high) return std::make_shared<OneLaw>(Cut(distribution_, *low, *high));
    return std::make_shared<OneLaw>(low ? Cut(distribution_, *low, Cut::LOWER) : Cut(distribution_, *high, Cut::UPPER));
  }

 private:
  OT::Distribution distribution_;
};

AnyLaw law(const OT::Distribution& distribution) { return std::make_shared<OneLaw>(distribution); }

class NormalCopula : public Copula {
 public:
  explicit NormalCopula(OT::NormalCopula copula) : copula_(std::move(copula)) {}
  void bind(std::vector<double>& shares) const override {
    const OT::Point bound = copula_.computeSequentialConditionalQuantile(point_of(shares));
    std::copy(bound.begin(), bound.end(), shares.begin());
  }

 private:
  OT::NormalCopula copula_;
};

OT::ComposedDistribution unit_cube(std::size_t keys) {
  return OT::ComposedDistribution(OT::ComposedDistribution::DistributionCollection(keys, OT::Uniform(0, 1)));
}

OT::LowDiscrepancyExperiment sobol(std::size_t keys, std::size_t count) {
  OT::LowDiscrepancyExperiment experiment(OT::SobolSequence(), unit_cube(keys), count, true);
  experiment.setRandomize(true);
  return experiment;
}

OT::Sample optimal(std::size_t keys, std::size_t count) {
  const OT::LHSExperiment start(unit_cube(keys), count, false, true);
  return OT::SimulatedAnnealingLHS(start, OT::SpaceFillingC2(), OT::GeometricProfile()).generate();
}

OT::Sample drawn(Design design, std::size_t count, std::size_t keys) {
  switch (design) {
    case Design::latin_hypercube: return OT::LHSExperiment(unit_cube(keys), count, true, true).generate();
    case Design::optimal_hypercube: return optimal(keys, count);
    case Design::monte_carlo: return OT::MonteCarloExperiment(unit_cube(keys), count).generate();
    case Design::sensitivity:
      return OT::SobolIndicesExperiment(OT::WeightedExperiment(sobol(keys, count)), false).generate();
    default: return sobol(keys, count).generate();
  }
}

/// A function for an optimiser, whose C code lets no exception through: the first one is kept.
class Called : public OT::EvaluationImplementation {
 public:
  Called(const std::function<double(const std::vector<double>&)>& function, std::size_t coordinates,
         std::exception_ptr& thrown)
      : function_(function), coordinates_(coordinates), thrown_(thrown) {}
  Called* clone() const override { return new Called(*this); }
  OT::UnsignedInteger getInputDimension() const override { return coordinates_; }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  OT::Point operator()(const OT::Point& point) const override {
    if (!thrown_) try {
        return OT::Point(1, function_(list_of(point)));
      } catch (...) {
        thrown_ = std::current_exception();
      }
    return OT::Point(1, 0.0);
  }

 private:
  const std::function<double(const std::vector<double>&)>& function_;
  std::size_t coordinates_;
  std::exception_ptr& thrown_;
};

class Module : public Library {
 public:
  AnyLaw uniform(double low, double high) const override { return law(OT::Uniform(low, high)); }
  AnyLaw normal(double mean, double deviation) const override { return law(OT::Normal(mean, deviation)); }
  AnyLaw lognormal(double mean, double deviation) const override {
    return law(OT::LogNormalMuSigma(mean, deviation, 0).getDistribution());
  }
  AnyLaw triangular(double low, double mode, double high) const override {
    return law(OT::Triangular(low, mode, high));
  }
  AnyLaw beta(double mean, double deviation, double low, double high) const override {
    return law(OT::BetaMuSigma(mean, deviation, low, high).getDistribution());
  }

  AnyLaw triangles(const std::vector<Triangle>& parts) const override {
    OT::Mixture::DistributionCollection laws;
    OT::Point shares;
    for (const Triangle& part : parts) {
      laws.add(OT::Triangular(part.from, part.top, part.to));
      shares.add(part.share);
    }
    return law(OT::Mixture(laws, shares));
  }

  AnyLaw places(const std::vector<double>& shares) const override {
    OT::Sample support(shares.size(), 1);
    for (std::size_t i = 0; i < shares.size(); ++i) support(i, 0) = static_cast<double>(i);
    return law(OT::UserDefined(support, point_of(shares)));
  }

  std::shared_ptr<const Copula> copula(std::size_t keys, const std::vector<RankCorrelation>& ranks) const override {
    OT::CorrelationMatrix matrix(keys);
    for (const RankCorrelation& one : ranks) matrix(one.first, one.second) = one.value;
    if (!matrix.isPositiveDefinite()) return {};
    try {
      OT::CorrelationMatrix normal = OT::NormalCopula::GetCorrelationFromSpearmanCorrelation(matrix);
      if (!normal.isPositiveDefinite()) return {};
      return std::make_shared<NormalCopula>(OT::NormalCopula(normal));
    } catch (const OT::Exception&) {
      return {};
    }
  }

  Lists draw(Design design, std::size_t count, std::size_t keys, unsigned long seed) const override {
    OT::TBB::Disable();  // so that the order of draws is one
    OT::RandomGenerator::SetSeed(seed);
    const OT::Sample sample = drawn(design, count, keys);
    Lists members;
    for (std::size_t k = 0; k < sample.getSize(); ++k) members.push_back(list_of(OT::Point(sample[k])));
    return members;
  }

  SobolIndices sobol_indices(const Lists& inputs, const std::vector<double>& outputs, std::size_t size) const override {
    OT::RandomGenerator::SetSeed(0);  // the intervals are bootstrapped: the same ones every time
    const OT::SaltelliSensitivityAlgorithm algorithm(sample_of(inputs), sample_of({outputs}), size);
    const OT::Interval first = algorithm.getFirstOrderIndicesInterval(),
                       total = algorithm.getTotalOrderIndicesInterval();
    return {list_of(algorithm.getFirstOrderIndices()), list_of(first.getLowerBound()), list_of(first.getUpperBound()),
            list_of(algorithm.getTotalOrderIndices()), list_of(total.getLowerBound()), list_of(total.getUpperBound())};
  }

  std::vector<double> rank_correlations(const Lists& inputs, const std::vector<double>& outputs) const override {
    return list_of(OT::CorrelationAnalysis(sample_of(inputs), sample_of({outputs})).computeSpearmanCorrelation());
  }

  std::vector<double> rank_regression(const Lists& inputs, const std::vector<double>& outputs) const override {
    try {
      auto found = list_of(OT::CorrelationAnalysis(sample_of(inputs), sample_of({outputs})).computeSRRC());
      for (const double value : found)
        if (!std::isfinite(value)) return {};
      return found;
    } catch (const OT::Exception&) {
      return {};
    }
  }

  std::vector<Dependence> hsic(const Lists& inputs, const std::vector<double>& outputs) const override {
    const OT::Sample x = sample_of(inputs).rank(), y = sample_of({outputs}).rank();
    OT::HSICEstimatorGlobalSensitivity::CovarianceModelCollection kernels;
    for (const OT::Sample& ranks : {x, y})
      for (const double deviation : ranks.computeStandardDeviation())
        kernels.add(OT::SquaredExponential(OT::Point(1, deviation), OT::Point(1, 1.0)));
    const OT::HSICEstimatorGlobalSensitivity estimator(kernels, x, y, OT::HSICUStat());
    try {
      const OT::Point r2 = estimator.getR2HSICIndices(), chance = estimator.getPValuesAsymptotic();
      std::vector<Dependence> all;
      for (std::size_t n = 0; n < inputs.size(); ++n) all.push_back({r2[n], chance[n]});
      return all;
    } catch (const std::exception&) {  // its gamma function overflows
      return {};
    }
  }

  void maximise(const std::function<double(const std::vector<double>&)>& function,
                const Region& region) const override {
    constexpr double last_radius = 0.1;  // over the first
    std::exception_ptr thrown;
    OT::OptimizationProblem problem(OT::Function(Called(function, region.from.size(), thrown)));
    problem.setMinimization(false);
    problem.setBounds(OT::Interval(point_of(region.low), point_of(region.high)));
    OT::Cobyla algorithm(problem, region.radius);
    algorithm.setStartingPoint(point_of(region.from));
    algorithm.setMaximumEvaluationNumber(static_cast<OT::UnsignedInteger>(region.most_calls));
    algorithm.setMaximumAbsoluteError(last_radius * region.radius);
    try {
      algorithm.run();
    } catch (const OT::Exception&) {  // it gives up where the calls are used up
    }
    if (thrown) std::rethrow_exception(thrown);
  }
};

}  // namespace
}  // namespace talus::openturns

extern "C" const talus::openturns::Library* talus_openturns() {
  static const talus::openturns::Module module;
  return &module;
}
