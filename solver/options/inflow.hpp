// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Inflow: material that enters through a line over time, by a hydrograph.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct SolveOptions;

/// The keys of [[solve.inflow]]: a line on the map through which material enters with a discharge over time.
struct InflowOptions {
  std::string name;                            ///< empty: inflow-1, inflow-2, ... (inflow_name())
  recipe::Pairs line;                          ///< map coordinates of its two ends [m]
  std::string place;                           ///< of the domain, whose line it is; empty: `line`
  std::filesystem::path file;                  ///< hydrograph; empty: the one below
  recipe::Pairs hydrograph;                    ///< times [s] and discharges [m3/s]
  double scale = 1;                            ///< of the discharges [-]
  std::optional<double> speed, depth, froude;  ///< one of them: along the ground [m/s], at the deepest [m], [-]
  std::optional<double> azimuth;               ///< of the flow, from north over east [deg]; none: across, downhill
  std::vector<int> points_per_cell{2, 2, 2};   ///< along the flow, across it, in height

  /// Declares the keys with defaults, help and what they need of `all` others; `shown`: the inflow in messages.
  void describe(recipe::Visitor& v, const std::string& shown, const SolveOptions& all);
};

/// The name of the inflow of this number, counted from 0.
std::string inflow_name(const InflowOptions& options, std::size_t number);

/// Declares [[solve.inflow]].
void describe_inflows(recipe::Visitor& v, std::vector<InflowOptions>& inflows, const SolveOptions& all);

}  // namespace talus::solver
