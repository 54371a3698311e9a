// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// probability.nc: the maps of an ensemble, and the table of its members. slides.nc: the table of slides.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/results.hpp"
#include "postprocess/maps/nc_file.hpp"

namespace talus::postprocess {

namespace {

/// Words of a column as CF's flags: blanks become underscores.
std::string flag_meanings(const std::vector<std::string>& words) {
  std::string text;
  for (std::string word : words) {
    std::replace(word.begin(), word.end(), ' ', '_');
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

/// Whether each row has a word of its own.
bool are_names(const RowColumn& column) { return column.name == "name" && column.words.size() == column.values.size(); }

/// The variables of a new group, one for each column. `called`: what a row is of, and the name of the dimension.
std::vector<int> define_members(Nc& nc, const MemberRows& rows, const char* group, const char* called) {
  std::vector<int> variables;
  nc.enter_group(group);
  const int dimension = nc.dimension(called, rows.states.size());
  const auto add = [&](const std::string& name, const std::string& words, const std::string& unit,
                       nc_type type = NC_DOUBLE) {
    const int id = nc.variable(name.c_str(), type, {dimension});
    nc.text(id, "long_name", words);
    if (!unit.empty()) nc.text(id, "units", unit);
    variables.push_back(id);
    return id;
  };
  const auto flags = [&](int id, const std::vector<std::string>& words) {
    std::vector<double> values;
    for (std::size_t n = 0; n < words.size(); ++n) values.push_back(static_cast<double>(n));
    nc.numbers(id, "flag_values", values);
    nc.text(id, "flag_meanings", flag_meanings(words));
  };
  add(called, fmt::format("number of the {}, from 0", called), "1");
  flags(add("state", fmt::format("what became of the {}", called), ""), {"waiting", "counted", "failed"});
  for (const RowColumn& column : rows.columns) {
    const int id = add(nc_name(column.name), column.title, column.unit, are_names(column) ? NC_STRING : NC_DOUBLE);
    if (!column.words.empty() && !are_names(column)) flags(id, column.words);
  }
  nc.leave_group();
  return variables;
}

/// Writes their values, once definitions have ended.
void fill_members(Nc& nc, const std::vector<int>& variables, const MemberRows& rows, const char* group) {
  nc.reenter_group(group);
  std::vector<double> numbers, states;
  for (std::size_t k = 0; k < rows.states.size(); ++k) {
    numbers.push_back(static_cast<double>(k));
    states.push_back(static_cast<double>(rows.states[k]));
  }
  nc.put(variables[0], numbers);
  nc.put(variables[1], states);
  for (std::size_t n = 0; n < rows.columns.size(); ++n)
    if (are_names(rows.columns[n]))
      nc.put_texts(variables[n + 2], rows.columns[n].words);
    else
      nc.put(variables[n + 2], rows.columns[n].values);
  nc.leave_group();
}

/// Attributes of a file about all members: `title` is behind the scene's, `source` behind the version.
void describe_members(Nc& nc, const Ensemble& ensemble, const std::string& title, const std::string& source,
                      const Options& options, const std::string& command_line) {
  describe_file(nc, ensemble.counts.scene.title + ": " + title, options.institution,
                "Talus " + version() + ", " + source, command_line);
  for (const auto& [name, words] : ensemble_facts(ensemble))
    if (name != "TITLE" && name != "SOURCE") nc.text(NC_GLOBAL, lower_case(name).c_str(), words);
}

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

/// The words of kinds of maps: about the quantity in the name of a variable, and before it in the long name.
constexpr struct {
  EnsembleMapKind kind;
  const char *before, *after, *words;
} kind_words[] = {
    {Kind::share, "probability_of_", "", "probability of "},
    {Kind::error, "probability_error_of_", "", "standard error of the probability of "},
    {Kind::to_halve, "members_to_halve_error_of_", "", "members that would halve the error of the probability of "},
    {Kind::quantile, "", "_quantile", "quantile of "},
    {Kind::mean, "", "_mean", ""},
    {Kind::deviation, "", "_deviation", ""}};

/// "peak_thickness" -> "probability_of_peak_thickness"; "peak_thickness_mean" and the hazard as they are.
std::string variable_name(const EnsembleMap& map) {
  for (const auto& [kind, before, after, words] : kind_words)
    if (kind == map.kind) return std::string(before) + counted_maps[map.tally].name + after;
  return "hazard_class";
}

bool by_threshold(const EnsembleMap& map) {
  return map.kind == Kind::share || map.kind == Kind::error || map.kind == Kind::to_halve;
}

/// What the whole variable is, whose maps are at several thresholds or shares.
std::string long_name(const EnsembleMap& map) {
  const CountedMap& what = counted_maps[map.tally];
  for (const auto& [kind, before, after, words] : kind_words)
    if (kind == map.kind && *words != '\0')
      return words + words_of(what) +
             (!by_threshold(map) ? ""
              : what.early       ? " of the threshold or less"
                                 : " of the threshold or more");
  return map.title;
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
  describe_members(nc, ensemble, "probability", "ensemble of runs of the material point method", options, command_line);
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
  const int id = nc.field(variable_name(map).c_str(), dimensions);
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
  for (const NcStack& stack : plan.stacks) {
    const bool several = by_threshold(stack.maps[0]) || stack.maps[0].kind == Kind::quantile;
    for (std::size_t n = 0; n < stack.maps.size(); ++n) {
      stop_if_interrupted("writing probability.nc");
      std::vector<double> values = values_of(ensemble, stack.maps[n], hazard);
      for (double& value : values)
        if (std::isnan(value)) value = nc_fill;
      if (several)
        nc.put_map(stack.variable, n, values);
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

void write_slides_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                         const Options& options, const std::string& command_line) {
  const EnsembleScene& scene = ensemble.counts.scene;
  Nc nc(file);
  describe_members(nc, ensemble, "slides", "a run of the material point method for each slide", options, command_line);
  if (!scene.grid.crs_wkt.empty()) define_crs(nc, scene.grid);
  const std::vector<int> variables = define_members(nc, rows, "slides", "slide");
  nc.end_definitions();
  fill_members(nc, variables, rows, "slides");
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
