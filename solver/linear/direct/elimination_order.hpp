// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A symmetric matrix renumbered for elimination, on the host.
#pragma once

#include <vector>

namespace talus {

/// The pattern of a matrix on the host: starts [rows + 1] and columns [entries].
struct HostPattern {
  std::vector<int> starts, columns;
};

/// One row and column for every three: the graph of the nodes.
HostPattern graph_of_nodes(const HostPattern& matrix);

/// A renumbered matrix: row r of it is row order[r] of the given one, entry k of it is entry source[k].
struct Renumbered {
  std::vector<int> order;
  HostPattern pattern;
  std::vector<int> source;
};

/// This function renumbers three rows at a time in the order of their nodes.
Renumbered renumber(const HostPattern& matrix, const std::vector<int>& node_order);

}  // namespace talus
