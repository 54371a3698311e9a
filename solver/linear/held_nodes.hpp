// What the nodes add to the tangent of the points, and what holds them.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus::solver {

/// Mass times inertia and other stiffness on the diagonal, and the directions a node may move in. Arrays over the
/// stored nodes.
struct HeldNodes {
  int count = 0;
  const double* mass = nullptr;             // [kg]
  const Sym3<double>* freed = nullptr;      // projector on the free directions; zero: held, and no unknown
  double inertia = 0;                       // [1/s2]; 0 in statics
  double shift = 0;                      // share by which the diagonal is raised: statics on few points has modes no point sees
  const Sym3<double>* stiffness = nullptr;  // of what else holds a node, friction say [N/m]; null: nothing
};

}  // namespace talus::solver
