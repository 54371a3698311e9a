// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays over the stored nodes that the kernels of an implicit step read and write.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus::solver {

/// The state of a node's contact with the surface that it can touch (bed or a frictional wall): there is none, it is
/// open, slips along the surface, or sticks to it.
enum class Touch : unsigned char { none, open, slips, sticks };

/// The arrays over the stored nodes, double whatever the precision of the points.
struct NodeArrays {
  double* mass = nullptr;            ///< [kg]
  Vec3<double>* velocity = nullptr;  ///< at the start of the step, from the points [m/s]
  Vec3<double>* arrival = nullptr;   ///< what the ground takes from it at once, where it points into the ground, and
                                     ///< what the bed's drag takes; null in statics [m/s]
  Vec3<double>* acceleration = nullptr;  ///< at the start of the step [m/s2]
  Vec3<double>* external = nullptr;      ///< at the end of the step [N]
  Vec3<double>* internal = nullptr;      ///< for the displacement u [N]
  Vec3<double>* u = nullptr;             ///< displacement of the step [m]
  Vec3<double>* residual = nullptr;      ///< unbalanced force, freed directions only [N]
  Sym3<double>* freed = nullptr;         ///< projector on the directions a node may move in
  Touch* touch = nullptr;

  /// The velocity that the step begins with [m/s].
  TALUS_HD Vec3<double> begin_velocity(int n) const { return arrival ? velocity[n] + arrival[n] : velocity[n]; }
};

}  // namespace talus::solver
