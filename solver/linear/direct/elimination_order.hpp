// A symmetric matrix renumbered for elimination, on the host.
#pragma once

#include <vector>

namespace talus {

/// Pattern of a matrix on the host.
struct HostPattern {
  std::vector<int> starts, columns;
};

/// One row and column for every three: the graph of the nodes.
HostPattern graph_of_nodes(const HostPattern& matrix);

/// Row r of the renumbered matrix is row order[r] of the given one; entry k of it is entry source[k].
struct Renumbered {
  std::vector<int> order;
  HostPattern pattern;
  std::vector<int> source;
};

/// Renumbers three rows at a time in the order of their nodes.
Renumbered renumber(const HostPattern& matrix, const std::vector<int>& node_order);

}  // namespace talus
