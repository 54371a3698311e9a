// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/history_group.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/run/check_values.hpp"

namespace talus {

const HistoryColumn* RunHistory::find(const std::string& name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const HistoryColumn& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

const HistoryColumn& RunHistory::at(const std::string& name) const {
  const HistoryColumn* column = find(name);
  if (!column) throw std::logic_error("RunHistory: no column " + name);
  return *column;
}

HistoryColumn& RunHistory::at(const std::string& name) {
  return const_cast<HistoryColumn&>(std::as_const(*this).at(name));
}

void write_history(h5::File& file, const RunHistory& history) {
  file.make_group("/history");
  for (const HistoryColumn& column : history.columns) {
    if (column.values.size() != history.columns[0].values.size())
      throw std::logic_error("RunHistory: columns of different lengths");
    const auto path = "/history/" + column.name;
    file.write<double>(path, {column.values.size()}, column.values);
    file.set_text(path, "unit", column.unit);
    if (!column.quantity.empty()) file.set_text(path, "quantity", column.quantity);
    if (!column.place.empty()) file.set_text(path, "place", column.place);
  }
}

RunHistory read_history(const h5::File& file) {
  RunHistory history;
  for (const auto& name : file.children("/history")) {
    const auto path = "/history/" + name;
    const h5::Dims dims{history.columns.empty() ? file.length(path) : history.columns[0].values.size()};
    const auto word = [&](const char* attribute) {
      return file.has_attribute(path, attribute) ? file.text(path, attribute) : std::string();
    };
    std::vector<double> values = file.read<double>(path, dims);
    if (name == "time_s") {
      h5::check_growing(file, path, values, false);
    } else {
      h5::check_values<double>(file, path, values, h5::finite_or_none);
    }
    history.columns.push_back({.name = name,
                               .unit = word("unit"),
                               .quantity = word("quantity"),
                               .place = word("place"),
                               .values = std::move(values)});
  }
  return history;
}

}  // namespace talus
