// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/csr_matrix.hpp"

#include <algorithm>
#include <utility>

namespace talus {

HostPattern graph_of_nodes(const HostPattern& matrix) {
  HostPattern graph;
  const std::size_t nodes = (matrix.starts.size() - 1) / 3;
  graph.starts.push_back(0);
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto begin = static_cast<std::size_t>(matrix.starts[3 * n]),
               end = static_cast<std::size_t>(matrix.starts[3 * n + 1]);
    for (std::size_t k = begin; k < end; k += 3) graph.columns.push_back(matrix.columns[k] / 3);
    graph.starts.push_back(static_cast<int>(graph.columns.size()));
  }
  return graph;
}

Renumbered renumber(const HostPattern& matrix, const std::vector<int>& node_order) {
  Renumbered r;
  for (const int node : node_order)
    for (int i = 0; i < 3; ++i) r.order.push_back(3 * node + i);
  std::vector<int> place(r.order.size());
  for (std::size_t row = 0; row < r.order.size(); ++row)
    place[static_cast<std::size_t>(r.order[row])] = static_cast<int>(row);
  r.pattern.columns.reserve(matrix.columns.size());
  r.source.reserve(matrix.columns.size());
  r.pattern.starts.push_back(0);
  std::vector<std::pair<int, int>> entries;  // column, source
  for (const int old : r.order) {
    entries.clear();
    for (int k = matrix.starts[static_cast<std::size_t>(old)]; k < matrix.starts[static_cast<std::size_t>(old) + 1];
         ++k)
      entries.emplace_back(place[static_cast<std::size_t>(matrix.columns[static_cast<std::size_t>(k)])], k);
    std::sort(entries.begin(), entries.end());
    for (const auto& [column, source] : entries) {
      r.pattern.columns.push_back(column);
      r.source.push_back(source);
    }
    r.pattern.starts.push_back(static_cast<int>(r.pattern.columns.size()));
  }
  return r;
}

}  // namespace talus
