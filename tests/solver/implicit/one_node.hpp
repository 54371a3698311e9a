// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One node on level ground, for tests of what kernels do with it.
#pragma once

#include "solver/implicit/residual.hpp"

namespace talus::solver::testing {

/// Numbers of the node, and the arrays of one that kernels see.
struct OneNode {
  double mass = 2, friction = 0.5, limit = 0, pull = 1e-9;
  Vec3<double> velocity, u, normal{0, 0, 1}, direction, way;
  Sym3<double> freed, walls = whole_space();
  Touch touch = Touch::sticks;
  ContactChanges changes{};
  bool dynamic = false, once = false;

  Constraints held() {
    return {.walls = &walls,
            .normal = &normal,
            .friction = &friction,
            .limit = &limit,
            .direction = &direction,
            .way = once ? &way : nullptr,
            .changes = &changes,
            .slip = 1e-3,
            .head_start = 1e-4,
            .pull = &pull};
  }
  NodeArrays nodes() { return {.mass = &mass, .velocity = &velocity, .u = &u, .freed = &freed, .touch = &touch}; }
  NewmarkScheme scheme() const { return {.dynamic = dynamic, .step = 0.1}; }
  /// The decision under external less internal force [N].
  bool decide(const Vec3<double>& force) { return DecideContact{nodes(), held(), scheme()}.decide(0, force); }
};

}  // namespace talus::solver::testing
