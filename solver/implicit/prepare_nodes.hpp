// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes at the start of an implicit step.
#pragma once

#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/implicit/residual.hpp"

namespace talus::solver {

/// One thread: one column of nodes. Makes velocities from momenta, loads and constraints; first guess of displacement.
template <class Real>
struct PrepareNodes {
  GridView<Real> grid;
  const int* active;
  NodeArrays nodes;
  Constraints held;
  Walls<double> walls;
  BaseFriction<double> base;
  double full_base;      ///< mass of a base node under a full layer [kg]
  Vec3<double> gravity;  ///< of the step, with its shaking [m/s2]
  NewmarkScheme scheme;
  BedColumns<double> columns;  ///< for what of the bed's tractions does not grow with speed
  bool predict;                ///< start from the displacement of the present velocity

  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    const BlockSlot slot = grid.slots[at.block];
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k)
      prepare(GridView<Real>::node(slot, at.i, at.j, k), at.i, at.j, k);
  }

 private:
  /// The acceleration by which a node's own weight presses on what it meets [m/s2]; shaking may lift it off.
  TALUS_HD double pressing(const Vec3<double>& normal) const { return fmax(-dot(gravity, normal), 0.0); }

  TALUS_HD void prepare(int n, int i, int j, int k) const {
    const double m = nodes.mass[n];
    nodes.touch[n] = Touch::none;
    held.limit[n] = 0;
    if (held.traction) held.traction[n] = 0;
    held.direction[n] = {};
    if (held.way) held.way[n] = {};
    held.changes[n] = {};
    if (!(m > 0) || i >= grid.columns || j >= grid.rows) {
      nodes.freed[n] = held.walls[n] = Sym3<double>{};
      nodes.u[n] = {};
      return;
    }
    nodes.velocity[n] = nodes.velocity[n] * (1 / m);
    if (nodes.acceleration) nodes.acceleration[n] = nodes.acceleration[n] * (1 / m);
    nodes.external[n] += gravity * m;
    const Place at{i, j, k};
    Meeting to;
    const bool grounded = touch_ground(at, to);
    if (scheme.dynamic) nodes.arrival[n] += arrive(nodes.begin_velocity(n), to.normal, to.friction);
    if (predict && trace(to.freed) > 0) to.u = nodes.begin_velocity(n) * scheme.step;
    for (int w = 0; w < walls.count; ++w) meet(walls.list[w], at, grounded, to);
    held.walls[n] = to.freed;
    held.normal[n] = to.normal;
    held.friction[n] = to.friction;
    if (dot(to.normal, to.normal) > 0) {
      to.u = to.u - to.normal * dot(to.u, to.normal);
      to.freed = without(to.freed, to.normal);
      nodes.touch[n] = begin_contact(n, to.normal, to.friction, to.freed);
      if (nodes.touch[n] == Touch::sticks) {
        to.freed = {};
        to.u = {};
      }
    }
    nodes.freed[n] = to.freed;
    nodes.u[n] = to.u;
  }

  struct Place {
    int i, j, k;
  };
  /// What a node meets, and what that leaves it.
  struct Meeting {
    Vec3<double> u{};                    ///< displacement to begin with [m]
    Sym3<double> freed = whole_space();  ///< directions that are free
    Vec3<double> normal{};               ///< of the surface that it can slip along; zero: none
    double friction = 0;
  };

  /// The state that a contact begins with: a node that the friction of its weight can stop within the step sticks.
  TALUS_HD Touch begin_contact(int n, const Vec3<double>& normal, double friction, const Sym3<double>& freed) const {
    if (!held.grips(n)) return Touch::slips;
    if (!scheme.dynamic) return Touch::sticks;
    const Vec3<double> v = freed * nodes.begin_velocity(n);
    const double speed = length(v);
    const double pull = held.traction ? held.traction[n] / nodes.mass[n] : 0;
    if (speed <= (friction * pressing(normal) + pull) * scheme.step) return Touch::sticks;
    held.direction[n] = v * (1 / speed);
    if (held.way) held.way[n] = v * scheme.step;
    return Touch::slips;
  }

  /// The change of velocity [m/s] with which the ground meets a node: where it bends, or is met, a node comes with a
  /// velocity into it. The ground takes that at once, and friction its share of the same impulse (T12), as in an
  /// explicit step; spread over the step by Newmark's rule it would count four times.
  TALUS_HD static Vec3<double> arrive(const Vec3<double>& v, const Vec3<double>& normal, double friction) {
    return meet_surface(v, normal, friction) - v;
  }

  TALUS_HD bool touch_ground(const Place& at, Meeting& to) const {
    const int column = grid.column(at.i, at.j);
    const int top = grid.contact_layer(column);
    if (at.k > top) return false;
    if (base.holds()) {
      to.freed = {};
      to.u = {};
      return true;
    }
    const double sx = static_cast<double>(grid.slope_x[column]), sy = static_cast<double>(grid.slope_y[column]);
    to.normal = normal_of(sx, sy);
    const int n = GridView<Real>::node(grid.slot(at.i, at.j), at.i, at.j, at.k);
    const Vec3<double> v = nodes.velocity[n];
    const double area = bed_area(nodes.mass[n], full_base, static_cast<double>(grid.spacing), sx, sy);
    // The reaction is not known yet; the node's own weight presses.
    const Slip<double> slip{.speed = length(v - to.normal * dot(v, to.normal)),
                            .normal_stress = nodes.mass[n] * pressing(to.normal) / area,
                            .duration = scheme.step};
    to.friction = base.base_coefficient(column, slip);
    if (held.traction && at.k == top && columns.mass[column] > 0) {
      const ColumnBed<double> under = bed_under(grid, columns.mass, at.i, at.j, Rim::wall);
      const LyingMatter<double> matter{.mass = columns.mass[column]};
      held.traction[n] =
          base.yield(base.at(column), column_slip(matter, under, {nullptr, scheme.step, {gravity}})) * under.area;
    }
    return true;
  }

  TALUS_HD void meet(const Wall<double>& wall, const Place& at, bool grounded, Meeting& to) const {
    if (!wall.holds(at.i, at.j, at.k)) return;
    Vec3<double> axis{};
    component(axis, wall.axis) = 1;
    if (wall.kind == WallKind::fixed) {
      to.freed = {};
      to.u = axis * (wall.speed * scheme.step);
      to.normal = {};
      return;
    }
    if (wall.kind == WallKind::frictional && !grounded) {
      to.normal = axis * static_cast<double>(wall.side);
      to.friction = wall.friction;
      return;
    }
    to.freed = without(to.freed, axis);
    component(to.u, wall.axis) = wall.speed * scheme.step;
  }
};

}  // namespace talus::solver
