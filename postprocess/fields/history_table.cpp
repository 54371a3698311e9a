// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/history_table.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace talus::postprocess {

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

}  // namespace talus::postprocess
