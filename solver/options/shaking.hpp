// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shaking of the ground: an accelerogram that acts on the mass as a body force.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct Shaking;
struct SolveOptions;

/// The unit of the accelerations in a file.
enum class ShakingUnit { m_s2, g, cm_s2 };

/// The keys of [solve.shaking].
struct ShakingOptions {
  std::filesystem::path file;  ///< empty: the ground rests
  ShakingUnit unit = ShakingUnit::m_s2;
  double scale = 1;                            ///< of the accelerations [-]
  double start = 0;                            ///< of the first row [s]
  std::optional<double> azimuth;               ///< of the column `along`, from north over east [deg]
  std::shared_ptr<const Shaking> record = {};  ///< instead of a file, as it acts; no key

  /// Whether the ground shakes.
  bool acts() const { return record || !file.empty(); }
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
