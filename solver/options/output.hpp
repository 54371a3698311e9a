// What a run writes, and how often.
#pragma once

#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct SolveOptions;

/// A point of the map at which the mass is watched.
struct GaugeOptions {
  std::string name;
  double x = 0, y = 0;  // map coordinates [m]
  void describe(recipe::Visitor& v);
};

struct OutputOptions {
  double frame_interval = 10;      // [s]
  double history_interval = 0.5;   // [s]
  double checkpoint_interval = 0;  // simulated [s]; 0: only when interrupted
  double map_threshold = 0.1;      // [m]
  bool point_frames = true;
  bool vdb_frames = false;
  bool energy_budget = false;
  bool deterministic = false;
  std::vector<GaugeOptions> gauges;
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
