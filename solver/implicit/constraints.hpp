// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What holds the nodes of an implicit step: rollers, surfaces that they can touch, and friction there.
#pragma once

#include "solver/implicit/node_arrays.hpp"

namespace talus::solver {

/// The projector on all directions.
TALUS_HD Sym3<double> whole_space() { return {1, 1, 1, 0, 0, 0}; }
/// The projector less direction n, where it is not held already.
TALUS_HD Sym3<double> without(const Sym3<double>& projector, const Vec3<double>& n) {
  if (!(dot(n, projector * n) > 0.5)) return projector;
  return projector + Sym3<double>{-n.x * n.x, -n.y * n.y, -n.z * n.z, -n.x * n.y, -n.y * n.z, -n.x * n.z};
}

/// How often a contact has changed in a step, in one byte. Neither count exceeds its limit (Constraints) by more than
/// one.
struct ContactChanges {
  unsigned char turns : 4;     ///< between stick and slip
  unsigned char closings : 4;  ///< from open
};
static_assert(sizeof(ContactChanges) == 1);

/// The constraints of the nodes, in arrays over the stored nodes, and the numbers of friction.
struct Constraints {
  Sym3<double>* walls = nullptr;      ///< projector on the directions that rollers and fixed walls leave free
  Vec3<double>* normal = nullptr;     ///< of the surface that a node can touch; zero: none
  double* friction = nullptr;         ///< coefficient there [-]
  double* traction = nullptr;         ///< of the bed, besides friction [N]; null where the law has none
  double* limit = nullptr;            ///< what friction can hold: the coefficient times the reaction found last, and
                                      ///< the traction [N]
  Vec3<double>* direction = nullptr;  ///< in which the node began to slip, or would slip [-]
  Vec3<double>* way = nullptr;        ///< [m] where a step is one linear solve, else null: that of the step at the
                                      ///< velocity it begins with. Friction is against that, its derivative the one
                                      ///< there
  ContactChanges* changes = nullptr;  ///< in this step
  double slip = 0;                    ///< over which friction grows to its limit, for nodes that changed too often [m]
  double head_start = 0;              ///< slip that a node which starts to slip has made already [m]
  const double* pull = nullptr;       ///< a contact opens when it would have to pull by more than this, or rounding
                                      ///< would open it [N]

  /// How often a node may change between stick and slip in a step (more made more cuts: docs/notes/newton.md); then its
  /// friction is smoothed instead. One that has closed too often stays closed to the step's end.
  static constexpr int most_turns = 1, most_closings = 3;
  /// Whether friction of node n is smoothed: it has changed between stick and slip too often.
  TALUS_HD bool smoothed(int n) const { return changes[n].turns > most_turns; }
  /// Whether node n has closed too often to open again in this step.
  TALUS_HD bool stays_closed(int n) const { return changes[n].closings >= most_closings; }
  /// Whether anything but the normal acts on node n at the surface it can touch.
  TALUS_HD bool grips(int n) const { return friction[n] > 0 || (traction && traction[n] > 0); }

  /// The friction force (T18) of a slipping node for the displacement u and, with `stiffness`, minus its derivative:
  /// Coulomb's cone over the displacement of the step, its limit held (Tresca), so that it has a potential and its
  /// derivative is symmetric. A node that starts to slip has its direction before it has moved.
  TALUS_HD Vec3<double> friction_force(int n, const Vec3<double>& u, Sym3<double>* stiffness) const {
    const bool rounded = smoothed(n);
    const double ahead = way ? 1 : rounded ? 0 : head_start, smooth = way ? 1e-12 : rounded ? slip : 1e-3 * head_start;
    const Vec3<double> along = u - normal[n] * dot(u, normal[n]) + (way ? way[n] : direction[n]) * ahead;
    const double size = sqrt(dot(along, along) + smooth * smooth);
    if (stiffness) {
      const double k = limit[n] / size, l = k / (size * size);
      *stiffness = Sym3<double>{k - l * along.x * along.x, k - l * along.y * along.y, k - l * along.z * along.z,
                                -l * along.x * along.y,    -l * along.y * along.z,    -l * along.x * along.z};
    }
    return along * (-limit[n] / size);
  }
};

}  // namespace talus::solver
