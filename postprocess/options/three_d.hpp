// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Table [postprocess.three_d] of a recipe.
#pragma once

#include "common/recipe/recipe.hpp"

namespace talus::postprocess {

/// What is written into OUT/3d for ParaView, Blender and Houdini, and whether the report has a view in 3-D.
struct ThreeDOptions {
  bool surface = true;    // of the flow over time, as a mesh
  bool terrain = true;    // with the maps on it
  bool points = false;    // material points over time
  bool volumes = false;   // density and velocity over time, OpenVDB
  double voxel = 0;       // of the volumes [m]; 0 = the cell, divided until it is no larger than a layer
  double largest = 4000;  // of 3d/, by estimate [MB]
  bool report = true;     // a view in the report

  /// True where something is written into OUT/3d.
  bool writes() const { return surface || terrain || points || volumes; }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
