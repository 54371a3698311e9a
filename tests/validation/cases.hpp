// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The cases of the validation. Each runs its recipe's variants, adds rows to the table and draws its pictures.
#pragma once

#include <numbers>

#include "tests/validation/bench.hpp"

namespace talus::validation {

/// What a row holds in place of a number that it does not have.
inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
inline constexpr double degree = std::numbers::pi / 180;  ///< [rad]

/// One way of solving the linear systems. A1 runs with each of them and compares; the studies of A2 take the last, the
/// systems of slender bodies being hard on iterations.
struct LinearScheme {
  std::string name;
  Overrides overrides;
};

/// What there is to compare, in one place.
inline const std::vector<LinearScheme>& linear_schemes() {
  static const std::vector<LinearScheme> schemes = {
      {"pcg", {{"solve.implicit.linear_solver", words("pcg")}}},
      {"cholesky", {{"solve.implicit.linear_solver", words("cholesky")}}}};
  return schemes;
}

void self_weight_column(Bench&);          // A1
void large_compaction(Bench&);            // A1b
void cantilever(Bench&);                  // A2
void cantilever_loads(Bench&);            // A2-loads
void cantilever_studies(Bench&);          // A2-studies
void sand_column(Bench&);                 // A3
void sand_column_paper(Bench&);           // A3-paper
void sand_column_studies(Bench&);         // A3-studies
void sand_column_friction(Bench&);        // A3-friction
void sand_column_aspects(Bench&);         // A3b
void round_sand_columns(Bench&);          // A3c
void step_cost(Bench&);                   // A4
void block_on_incline(Bench&);            // B1
void velocity_weakening(Bench&);          // B2
void energy_line(Bench&);                 // B3
void parabolic_cap(Bench&);               // B4
void dam_break(Bench&);                   // B5
void elastic_motion(Bench&);              // B6
void shaken_block(Bench&);                // B7
void blocks_of_unknown_friction(Bench&);  // B8
void large_steps(Bench&);                 // C1
void homogeneous_slope(Bench&);           // D1
void slope_on_foundation(Bench&);         // D2
void slope_on_seam(Bench&);               // D3
void rock_wedge(Bench&);                  // D4
void undrained_cut(Bench&);               // D5
void wet_columns(Bench&);                 // E1
void debris_flow_flume(Bench&);           // E2

}  // namespace talus::validation
