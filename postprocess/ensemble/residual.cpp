// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/residual.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "postprocess/ensemble/comparison.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"

namespace talus::postprocess {
namespace {

/// The mean size of the thickness's discrepancy [m]; NaN where none was compared.
double discrepancy_of_thickness(const Json& likelihood) {
  if (likelihood.is_null()) return nan;
  for (const Json& kind : likelihood["compared"]) {
    if (kind["name"] != thickness_compared) continue;
    double mean = 0;
    for (const Json& entry : kind["discrepancy"]) mean += entry[0].get<double>() * entry[2].get<double>();
    return mean;
  }
  return nan;
}

EnsembleMap deposit_map(EnsembleMapKind kind) {
  const auto deposit = std::ranges::find_if(
      counted_maps, [](const CountedMap& one) { return std::string_view(one.name) == "deposit_thickness"; });
  return {kind, static_cast<std::size_t>(deposit - std::begin(counted_maps)), 0, nan, "", "", "m"};
}

}  // namespace

std::vector<double> residual_in_sigma(const Ensemble& ensemble, const std::optional<Survey>& survey,
                                      const MemberRows& rows, const Options& options) {
  if (ensemble.table.design != design_name(Design::posterior) || !survey || survey->deposit.empty()) return {};
  const double discrepancy = discrepancy_of_thickness(rows.likelihood);
  if (std::isnan(discrepancy)) return {};
  const MapGrid& grid = ensemble.counts.scene.grid;
  const std::vector<double> surveyed =
                                on_grid({survey->grid, comparable_deposit(*survey, ensemble.counts.scene)}, grid),
                            error = on_grid({survey->grid, deviation_of(survey->error, survey->deposit.size())}, grid),
                            mean = values_of(ensemble, deposit_map(EnsembleMapKind::mean), options.hazard),
                            spread = values_of(ensemble, deposit_map(EnsembleMapKind::deviation), options.hazard);
  std::vector<double> residual(grid.count(), nan);
  for (std::size_t cell = 0; cell < residual.size(); ++cell)
    if (std::fmax(surveyed[cell], mean[cell]) > options.deposit_threshold)
      residual[cell] = (surveyed[cell] - mean[cell]) / std::hypot(error[cell], discrepancy, spread[cell]);
  return residual;
}

}  // namespace talus::postprocess
