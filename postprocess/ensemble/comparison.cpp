// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/ranges.h>

#include "common/map/limits.hpp"
#include "postprocess/ensemble/block_means.hpp"

namespace talus::postprocess {
namespace {

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

Compared compared_in(const BlockMeans& blocks, const char* name, const char* unit,
                     const std::vector<double>& surveyed) {
  Compared compared{name, unit, blocks.of(surveyed), blocks.places(), {}, 0, blocks.side() / 2, blocks.extent()};
  compared.surveyed.back() = blocks.volume_beside(surveyed);
  compared.scale = root_mean_square({compared.surveyed.begin(), compared.surveyed.end() - 1});
  return compared;
}

/// Half the difference of a cell's neighbours along x or y; 0 where one is not known.
std::vector<double> slope(const MapGrid& grid, const std::vector<double>& values, int x, int y) {
  std::vector<double> slopes(values.size(), 0.0);
  each_cell(grid, [&](int column, int row) {
    if (!grid.holds(column - x, row - y) || !grid.holds(column + x, row + y)) return;
    const double half = (values[grid.index(column + x, row + y)] - values[grid.index(column - x, row - y)]) / 2;
    if (std::isfinite(half)) slopes[grid.index(column, row)] = half;
  });
  return slopes;
}

/// A map of a run by blocks, with the modes of a mass that is too thick, or lies elsewhere, as a whole.
Simulated simulated_map(const MapGrid& grid, const BlockMeans& blocks, const std::vector<double>& values) {
  Simulated simulated{blocks.of(values), {}};
  simulated.modes = {simulated.numbers, blocks.of(slope(grid, values, 1, 0)), blocks.of(slope(grid, values, 0, 1))};
  for (std::vector<double>& mode : simulated.modes) mode.back() = 0;
  return simulated;
}

std::vector<char> cells_above(const std::vector<double>& values, double threshold) {
  std::vector<char> above;
  for (const double value : values) above.push_back(value > threshold ? 1 : 0);
  return above;
}

/// A number of all members, [members].
struct NumberOfMembers {
  const char* unit;
  std::vector<double> values;
};

/// The result of this name. Throws DataError where no member has it.
NumberOfMembers number_of(const EnsembleCounts& counts, const std::string& name) {
  for (const ResultNumber& number : result_numbers) {
    if (name != number.name) continue;
    std::vector<double> values;
    for (const MemberResult& result : counts.results) values.push_back(result.*(number.value));
    return {number.unit, std::move(values)};
  }
  std::vector<std::string> names;
  for (const auto& [at_gauge, values] : counts.at_gauges()) {
    if (at_gauge == name) return {unit_at_gauge(name), values};
    names.push_back(at_gauge);
  }
  throw DataError({fmt::format("[[calibrate.number]] result = \"{}\": no member has it", name),
                   names.empty() ? "[solve] has no gauges" : fmt::format("there are {}", fmt::join(names, ", ")),
                   "Name a [[solve.gauge]], and run talus-solve again"});
}

bool holds_any(const std::vector<char>& cells) { return std::ranges::find(cells, 1) != cells.end(); }

}  // namespace

std::vector<double> deviation_of(const SurveyError& error, std::size_t cells) {
  constexpr double sure = 5;  // the noise over its standard deviation
  return error.sigma.empty() ? std::vector<double>(cells, error.noise / sure) : error.sigma;
}

std::vector<double> covered_shares(const Footprint& footprint, const MapGrid& from, const MapGrid& to) {
  const std::vector<std::uint8_t> cells = cells_of(footprint, from.count());
  std::vector<double> share = on_grid({from, {cells.begin(), cells.end()}}, to);
  for (double& value : share)
    if (!(value > 0)) value = 0;
  return share;
}

Comparison::Comparison(const EnsembleCounts& counts, const Survey& survey, const std::vector<double>& deposit,
                       const CalibrateOptions& options, double deposit_threshold)
    : counts_(counts), survey_(survey) {
  if (counts.other_cells) return;  // an error budget, whose members are no draws
  const bool kept = std::ranges::any_of(counts.deposit_thickness, [](const KeptThickness& one) { return one.kept(); });
  const std::vector<char> mass = cells_above(deposit, deposit_threshold);
  if (holds_any(mass) && kept) {
    add_thickness(deposit, mass, std::max(deposit_threshold, survey.usual_level()));
  } else if (holds_any(mass)) {
    std::vector<double> covered = deposit;
    for (std::size_t cell = 0; cell < covered.size(); ++cell)
      if (std::isfinite(covered[cell])) covered[cell] = mass[cell];
    add_outline("outline of the deposit", covered, counts.deposit);
  }
  if (!survey.footprint.empty() && !survey.footprint_is_change) {
    std::vector<double> covered = survey.footprint;
    for (double& value : covered)
      if (std::isfinite(value)) value = value > survey.footprint_threshold ? 1 : 0;
    add_outline("outline of the flow", covered, counts.flow);
  }
  for (const CalibrateNumber& number : options.numbers) add_number(number);
}

void Comparison::add(Compared compared, double side, Simulate simulate) {
  Likelihood likelihood(compared);
  kinds_.push_back({std::move(compared), side, std::move(likelihood), std::move(simulate),
                    std::vector<std::vector<double>>(counts_.states.size())});
}

void Comparison::add_thickness(const std::vector<double>& deposit, const std::vector<char>& inside, double least) {
  std::vector<double> measured = survey_.measured.empty() ? deposit : survey_.measured;
  for (std::size_t cell = 0; cell < measured.size(); ++cell)
    if (!std::isfinite(deposit[cell])) measured[cell] = nan;
  const BlockMeans blocks(survey_.grid, measured, inside, counts_.scene.grid.cell, least);
  Compared compared = compared_in(blocks, thickness_compared, "m", measured);
  compared.error = blocks.covariance(deviation_of(survey_.error, measured.size()), survey_.error.correlation_length);
  const auto simulate = [this, blocks](std::size_t, const OnSurveyGrid* kept) {
    return kept == nullptr ? Simulated{} : simulated_map(survey_.grid, blocks, kept->change);
  };
  add(std::move(compared), blocks.side(), simulate);
}

void Comparison::add_outline(const char* name, const std::vector<double>& covered,
                             const std::vector<Footprint>& footprints) {
  const std::vector<char> inside = cells_above(covered, 0);
  if (!holds_any(inside)) return;
  const BlockMeans blocks(survey_.grid, covered, inside, counts_.scene.grid.cell, 0);
  Compared compared = compared_in(blocks, name, "1", covered);
  compared.error.assign(compared.surveyed.size() * compared.surveyed.size(), 0.0);
  const auto simulate = [this, blocks, &footprints](std::size_t k, const OnSurveyGrid*) {
    return simulated_map(survey_.grid, blocks, covered_shares(footprints[k], counts_.scene.grid, survey_.grid));
  };
  add(std::move(compared), blocks.side(), simulate);
}

void Comparison::add_number(const CalibrateNumber& number) {
  NumberOfMembers of = number_of(counts_, number.result);
  Compared compared{
      number.result, of.unit, {number.value}, {}, {number.deviation * number.deviation}, std::abs(number.value), 0, 0};
  const auto simulate = [values = std::move(of.values)](std::size_t k, const OnSurveyGrid*) {
    return Simulated{{values[k]}, {}};
  };
  add(std::move(compared), 0, simulate);
}

void Comparison::compare(std::size_t k, const OnSurveyGrid* kept) {
  for (Kind& kind : kinds_)
    if (const Simulated simulated = kind.simulate(k, kept); !simulated.numbers.empty())
      kind.by_discrepancy[k] = kind.likelihood.by_discrepancy(simulated);
}

std::vector<double> Comparison::logarithms() const {
  std::vector<double> sums(counts_.states.size(), 0.0);
  for (const Kind& kind : kinds_)
    for (std::size_t k = 0; k < sums.size(); ++k)
      sums[k] += kind.by_discrepancy[k].empty() ? nan : log_mean(kind.by_discrepancy[k]);
  return sums;
}

Json Comparison::json(bool drawn) const {
  const std::vector<double> logarithms = this->logarithms();
  double most = -std::numeric_limits<double>::infinity();
  for (const double value : logarithms) most = std::fmax(most, value);
  Json json{{"log_likelihood", Json::array()}, {"compared", Json::array()}};
  for (const double value : logarithms) json["log_likelihood"].push_back(std::isfinite(value) ? Json(value) : Json());
  for (const Kind& kind : kinds_) {
    const std::vector<Discrepancy>& table = kind.likelihood.table();
    std::vector<double> probable(table.size(), 0.0);
    double all = 0, error = 0;
    for (std::size_t k = 0; k < logarithms.size(); ++k) {
      if (!std::isfinite(logarithms[k])) continue;
      const double weight = drawn ? 1 : std::exp(logarithms[k] - most), own = log_mean(kind.by_discrepancy[k]);
      all += weight;
      for (std::size_t n = 0; n < table.size(); ++n)
        probable[n] += weight * std::exp(kind.by_discrepancy[k][n] - own) / static_cast<double>(table.size());
    }
    const std::size_t n = kind.compared.surveyed.size();
    for (std::size_t a = 0; a < n; ++a) error += kind.compared.error[a * n + a] / static_cast<double>(n);
    Json discrepancy = Json::array();
    for (std::size_t entry = 0; entry < table.size(); ++entry)
      discrepancy.push_back({table[entry].deviation, table[entry].length, all > 0 ? probable[entry] / all : 0});
    json["compared"].push_back({{"name", kind.compared.name},
                                {"unit", kind.compared.unit},
                                {"numbers", n},
                                {"block_m", kind.side},
                                {"usual_size", kind.compared.scale},
                                {"survey_error", std::sqrt(error)},
                                {"discrepancy", std::move(discrepancy)}});
  }
  return json;
}

}  // namespace talus::postprocess
