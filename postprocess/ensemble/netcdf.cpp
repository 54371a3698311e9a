// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// probability.nc: the maps of an ensemble, and the table of its members.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "postprocess/ensemble/facts.hpp"
#include "postprocess/ensemble/hazard.hpp"
#include "postprocess/ensemble/netcdf_members.hpp"
#include "postprocess/ensemble/sampling_error.hpp"
#include "postprocess/ensemble/write_maps.hpp"
#include "postprocess/maps/nc_grid.hpp"

namespace talus::postprocess {
namespace {

using Kind = EnsembleMapKind;

/// A variable of the file: the maps that follow one another in it, one for each value of its first coordinate.
struct NcStack {
  int variable = -1;
  std::vector<EnsembleMap> maps;
};

/// The file's variables, defined first and filled afterwards.
struct NcPlan {
  NcAxes axes;
  std::vector<std::pair<int, std::vector<double>>> coordinates;
  std::vector<NcStack> stacks;
  std::vector<int> members;
};

/// "peak_thickness" -> "probability_of_peak_thickness"; "peak_thickness_mean" and the hazard as they are.
std::string variable_name(const EnsembleMap& map) {
  const std::string what = counted_maps[map.tally].name;
  switch (map.kind) {
    case Kind::share: return "probability_of_" + what;
    case Kind::error: return "probability_error_of_" + what;
    case Kind::to_halve: return "members_to_halve_error_of_" + what;
    case Kind::quantile: return what + "_quantile";
    case Kind::mean: return what + "_mean";
    case Kind::deviation: return what + "_deviation";
    case Kind::count: return "members_of_" + what;
    case Kind::largest: return "largest_" + what;
    case Kind::hazard: break;
  }
  return "hazard_class";
}

bool by_threshold(const EnsembleMap& map) {
  return map.kind == Kind::share || map.kind == Kind::error || map.kind == Kind::to_halve;
}

/// What the whole variable is, whose maps are at several thresholds or shares.
std::string long_name(const EnsembleMap& map) {
  const CountedMap& what = counted_maps[map.tally];
  const std::string words = words_of(what) + (what.early ? " of the threshold or less" : " of the threshold or more");
  switch (map.kind) {
    case Kind::share: return "probability of " + words;
    case Kind::error: return "standard error of the probability of " + words;
    case Kind::to_halve: return "members that would halve the error of the probability of " + words;
    case Kind::quantile: return "quantile of " + words_of(what);
    default: return map.title;
  }
}

int define_coordinate(Nc& nc, NcPlan& plan, const std::string& name, const std::string& words, const std::string& unit,
                      const std::vector<double>& values) {
  const int dimension = nc.dimension(name.c_str(), values.size());
  const int id = nc.variable(name.c_str(), NC_DOUBLE, {dimension});
  nc.text(id, "long_name", words);
  nc.text(id, "units", unit);
  plan.coordinates.emplace_back(id, values);
  return dimension;
}

void describe(Nc& nc, const Ensemble& ensemble, const Options& options, const std::string& command_line) {
  describe_members_file(nc, ensemble, "probability", "ensemble of runs of the material point method", options,
                        command_line);
  nc.text(NC_GLOBAL, "comment",
          share_words(ensemble.table.design).meaning + " " + share_words(ensemble.table.design).error +
              " Thickness is vertical (along the plumb line), not normal to the slope. Cells outside the computed "
              "domain hold the fill value.");
}

/// Defines the variable of a map unless it is there already, and adds the map to it.
void define_map(Nc& nc, NcPlan& plan, const EnsembleMap& map, const MapGrid& grid, int first_dimension,
                const std::string& comment) {
  std::vector<int> dimensions{plan.axes.y.dimension, plan.axes.x.dimension};
  if (first_dimension >= 0) dimensions.insert(dimensions.begin(), first_dimension);
  const int id = nc.field(variable_name(map).c_str(), dimensions, static_cast<std::size_t>(grid.rows),
                          static_cast<std::size_t>(grid.columns));
  nc.text(id, "long_name", long_name(map));
  nc.text(id, "units", map.unit);
  if (!comment.empty()) nc.text(id, "comment", comment);
  if (!grid.crs_wkt.empty()) nc.text(id, "grid_mapping", "crs");
  plan.stacks.push_back({id, {map}});
}

void define_maps(Nc& nc, NcPlan& plan, const Ensemble& ensemble, const HazardOptions& hazard) {
  const int quantiles = define_coordinate(nc, plan, "quantile", "share of the members that does not exceed the value",
                                          "1", {std::begin(quantile_shares), std::end(quantile_shares)});
  int threshold = -1;
  for (const EnsembleMap& map : ensemble_maps(ensemble, hazard)) {
    const CountedMap& what = counted_maps[map.tally];
    const auto same = [&](const NcStack& stack) {
      return stack.maps[0].kind == map.kind && stack.maps[0].tally == map.tally;
    };
    const bool several = by_threshold(map) || map.kind == Kind::quantile;
    const auto found = std::find_if(plan.stacks.begin(), plan.stacks.end(), same);
    if (several && found != plan.stacks.end()) {
      found->maps.push_back(map);
      continue;
    }
    if (map.kind == Kind::share)
      threshold = define_coordinate(nc, plan, std::string(what.name) + "_threshold", "threshold of " + words_of(what),
                                    what.unit, ensemble.counts.maps[map.tally].thresholds);
    std::string comment;
    for (const auto& [name, words] : map_facts(ensemble, map, hazard))
      if (name == "ERROR_MEANING" || name == "HAZARD_MATRIX" || (name == "MEANING" && !by_threshold(map)))
        comment += (comment.empty() ? "" : ". ") + words;
    define_map(nc, plan, map, ensemble.counts.scene.grid,
               by_threshold(map)            ? threshold
               : map.kind == Kind::quantile ? quantiles
                                            : -1,
               comment);
  }
}

void fill_maps(Nc& nc, const NcPlan& plan, const Ensemble& ensemble, const HazardOptions& hazard) {
  const MapGrid& grid = ensemble.counts.scene.grid;
  for (const NcStack& stack : plan.stacks) {
    const bool several = by_threshold(stack.maps[0]) || stack.maps[0].kind == Kind::quantile;
    for (std::size_t n = 0; n < stack.maps.size(); ++n) {
      stop_if_interrupted("writing probability.nc");
      std::vector<double> values = values_of(ensemble, stack.maps[n], hazard);
      for (double& value : values)
        if (std::isnan(value)) value = nc_fill;
      if (several)
        nc.put_map(stack.variable, n, static_cast<std::size_t>(grid.rows), static_cast<std::size_t>(grid.columns),
                   values);
      else
        nc.put(stack.variable, values);
    }
  }
}

}  // namespace

void write_probability_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                              const Options& options, const std::string& command_line) {
  const MapGrid& grid = ensemble.counts.scene.grid;
  Nc nc(file);
  NcPlan plan;
  describe(nc, ensemble, options, command_line);
  plan.axes = define_axes(nc, grid);
  if (!grid.crs_wkt.empty()) define_crs(nc, grid);
  define_maps(nc, plan, ensemble, options.hazard);
  plan.members = define_members(nc, rows, "members", "member");
  nc.end_definitions();
  fill_axes(nc, plan.axes, grid);
  for (const auto& [id, values] : plan.coordinates) nc.put(id, values);
  fill_maps(nc, plan, ensemble, options.hazard);
  fill_members(nc, plan.members, rows, "members");
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
