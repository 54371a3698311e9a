// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Table [postprocess.three_d] of a recipe.
#pragma once

#include "common/recipe/recipe.hpp"

namespace talus::postprocess {

/// What is written into OUT/3d for ParaView, and whether the report has a view in 3-D.
struct ThreeDOptions {
  bool surface = true;    // of the flow over time, as a mesh
  bool terrain = true;    // with the maps on it
  bool points = false;    // material points over time
  double largest = 4000;  // of 3d/, by estimate [MB]
  bool report = true;     // a view in the report

  /// True where something is written into OUT/3d.
  bool writes() const { return surface || terrain || points; }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
