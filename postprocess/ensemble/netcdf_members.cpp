// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/netcdf_members.hpp"

#include <algorithm>
#include <cctype>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "postprocess/ensemble/facts.hpp"
#include "postprocess/maps/nc_grid.hpp"

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

}  // namespace

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

std::string nc_lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

void describe_members_file(Nc& nc, const Ensemble& ensemble, const std::string& title, const std::string& source,
                           const Options& options, const std::string& command_line) {
  nc.text(NC_GLOBAL, "Conventions", "CF-1.8");
  nc.text(NC_GLOBAL, "title", ensemble.counts.scene.title + ": " + title);
  nc.text(NC_GLOBAL, "institution", options.institution.empty() ? "not stated" : options.institution);
  nc.text(NC_GLOBAL, "source", "Talus " + version() + ", " + source);
  nc.text(NC_GLOBAL, "history",
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}: {}", fmt::gmtime(std::time(nullptr)), command_line));
  for (const auto& [name, words] : ensemble_facts(ensemble))
    if (name != "TITLE" && name != "SOURCE") nc.text(NC_GLOBAL, nc_lower(name).c_str(), words);
}

}  // namespace talus::postprocess
