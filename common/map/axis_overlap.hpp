// How the cells of one regular axis cover those of another.
#pragma once

#include <vector>

namespace talus {

struct Axis {
  double start = 0;  // outer edge of cell 0 [m]
  double cell = 0;   // [m]
  int count = 0;
};

/// A source cell and the length it shares with a target cell [m].
struct Overlap {
  int source = 0;
  double length = 0;
};

/// For each target cell the source cells that overlap it, in order. [target.count]
std::vector<std::vector<Overlap>> axis_overlaps(const Axis& source, const Axis& target);

}  // namespace talus
