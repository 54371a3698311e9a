// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/maps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

struct PlaceColumns {
  std::string name;    ///< "bridge"
  std::string prefix;  ///< of its columns: "gauge_bridge_"
  std::vector<const HistoryColumn*> columns;
};

std::vector<PlaceColumns> places_of(const RunHistory& history, const std::string& kind) {
  std::vector<PlaceColumns> places;
  for (const HistoryColumn& column : history.columns) {
    if (!column.place.starts_with(kind + " ")) continue;
    const std::string name = column.place.substr(kind.size() + 1);
    auto found = std::find_if(places.begin(), places.end(), [&](const auto& place) { return place.name == name; });
    if (found == places.end()) found = places.insert(places.end(), {name, fmt::format("{}_{}_", kind, name), {}});
    found->columns.push_back(&column);
  }
  return places;
}

std::string table_of(const RunHistory& history, const std::string& kind, const std::vector<PlaceColumns>& places) {
  const std::vector<double>& time = history.at("time_s").values;
  std::string text = "time_s," + kind;
  for (const HistoryColumn* column : places.front().columns)
    text += "," + column->name.substr(places.front().prefix.size());
  for (std::size_t row = 0; row < time.size(); ++row)
    for (const PlaceColumns& place : places) {
      text += fmt::format("\n{:.9g},{}", time[row], csv_field(place.name));
      for (const HistoryColumn* column : place.columns) text += fmt::format(",{:.9g}", column->values[row]);
    }
  return text + "\n";
}

void describe_history(Nc& nc, const Run& run) {
  nc.text(NC_GLOBAL, "Conventions", "CF-1.8");
  nc.text(NC_GLOBAL, "title", run.summary.title + ": history");
  nc.text(NC_GLOBAL, "source", "Talus " + run.summary.version + ", material point method");
  const std::string id = fact(run.summary.provenance, run_id);
  nc.text(NC_GLOBAL, "run_id", id.empty() ? "not known" : id);
}

int define_column(Nc& nc, int time, const HistoryColumn& column, const std::string& name) {
  const int id = nc.variable(name.c_str(), NC_DOUBLE, {time});
  nc.text(id, "units", column.unit);
  nc.text(id, "long_name", column.quantity.empty() ? column.name : column.quantity + ", " + column.place);
  if (!column.place.empty()) nc.text(id, "place", column.place);
  nc.numbers(id, "_FillValue", {nc_fill});
  return id;
}

/// Time series as comma-separated values, a row for every record, time first.
std::string history_table(const RunHistory& history) {
  std::vector<const HistoryColumn*> order;
  for (const HistoryColumn& column : history.columns) order.push_back(&column);
  std::stable_partition(order.begin(), order.end(),
                        [](const HistoryColumn* column) { return column->name == "time_s"; });
  std::string text;
  for (const HistoryColumn* column : order) text += (text.empty() ? "" : ",") + column->name;
  const std::size_t rows = order.empty() ? 0 : order.front()->values.size();
  for (std::size_t row = 0; row < rows; ++row) {
    text += "\n";
    for (const HistoryColumn* column : order)
      text += fmt::format("{}{:.9g}", column == order.front() ? "" : ",", column->values[row]);
  }
  return text + "\n";
}

}  // namespace

Writer history_writer() {
  return {.name = "history",
          .names = {"history.csv", "history.nc", "gauges.csv", "sections.csv"},
          .write =
              [](const Job& job) {
                Files files{write_file(job, "history.csv", history_table(job.run.history)),
                            write_file(job, "history.nc", history_netcdf(job.run, job.options.start_time))};
                for (const auto& [kind, rows] : place_tables(job.run.history))
                  files.push_back(write_file(job, kind + "s.csv", rows));
                return files;
              },
          .outdated = std::vector<std::string>{"gauges.csv", "sections.csv"}};
}

std::vector<std::pair<std::string, std::string>> place_tables(const RunHistory& history) {
  std::vector<std::pair<std::string, std::string>> tables;
  for (const std::string kind : {"gauge", "section"}) {
    const auto places = places_of(history, kind);
    if (!places.empty()) tables.emplace_back(kind, table_of(history, kind, places));
  }
  return tables;
}

std::string history_netcdf(const Run& run, const std::string& start) {
  const HistoryColumn* time = run.history.find("time_s");
  Nc nc("history.nc");
  describe_history(nc, run);
  std::vector<std::pair<int, const HistoryColumn*>> variables;
  if (time != nullptr && !time->values.empty()) {
    const int dimension = nc.dimension("time", time->values.size());
    variables.emplace_back(define_time(nc, dimension, start), time);
    std::vector<std::string> taken{"time"};
    for (const HistoryColumn& column : run.history.columns) {
      if (&column == time) continue;
      std::string name = nc_name(column.name);
      while (std::find(taken.begin(), taken.end(), name) != taken.end()) name += "_";  // "a-b" after "a_b"
      taken.push_back(name);
      variables.emplace_back(define_column(nc, dimension, column, name), &column);
    }
  }
  nc.end_definitions();
  for (const auto& [id, column] : variables) {
    std::vector<double> values = column->values;
    std::replace_if(
        values.begin(), values.end(), [](double v) { return std::isnan(v); }, nc_fill);
    nc.put(id, values);
  }
  return nc.close();
}

}  // namespace talus::postprocess
