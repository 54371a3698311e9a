// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/cases.hpp"

namespace talus::validation {

const std::vector<Case>& cases() {
  static const std::vector<Case> list = {
      {"A1", "self-weight column", true, self_weight_column},
      {"A1b", "column compacted to a third", true, large_compaction},
      {"A2", "cantilever with a load at its tip", true, cantilever},
      {"A2-loads", "cantilever under growing load", false, cantilever_loads},
      {"A2-studies", "cantilever over points per cell and load steps", false, cantilever_studies},
      {"A3", "collapse of a sand column", true, sand_column, true},
      {"A3-paper", "the same on the paper's grid with its 64 points per cell", false, sand_column_paper},
      {"A3-studies", "reach of the sand column over points per cell and step", false, sand_column_studies},
      {"A3-friction", "run-out of the sand column over damping and base friction", false, sand_column_friction},
      {"A3b", "sand columns of other aspect ratios", false, sand_column_aspects, true},
      {"A3c", "round columns of sand", false, round_sand_columns},
      {"A4", "time and memory of a step", true, step_cost},
      {"B1", "block on an incline", true, block_on_incline},
      {"B2", "block on a bed that weakens with speed", true, velocity_weakening},
      {"B3", "heap on curved ground, facing any direction", true, energy_line, true},
      {"B4", "parabolic cap on a plane", true, parabolic_cap, true},
      {"B5", "dam break on a slope", true, dam_break, true},
      {"B6", "vibrating bar, free fall, patch test", true, elastic_motion},
      {"B7", "block on shaking ground", true, shaken_block},
      {"B8", "blocks of unknown friction, an ensemble", true, blocks_of_unknown_friction, true},
      {"C1", "sand column in long steps", true, large_steps, true},
      {"D1", "factor of safety of a homogeneous slope", true, homogeneous_slope, true},
      {"D2", "the same on a foundation layer", true, slope_on_foundation},
      {"D3", "factor of safety of a slope on a weak seam", true, slope_on_seam},
      {"D4", "factor of safety of a wedge", true, rock_wedge},
      {"D5", "factor of safety of an undrained vertical cut", true, undrained_cut},
  };
  return list;
}

}  // namespace talus::validation
