// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points in an implicit step: springs that push the mass off the surface and hold it back along it, up to
// friction's limit (penalty with return to Coulomb's cone; Simo & Laursen 1992). Their force goes on from that of the
// last step, so that what rests stays where it is, whatever the stiffness.
#pragma once

#include "solver/boundary/surface_contact.hpp"
#include "solver/implicit/node_fields.hpp"

namespace talus::solver {

/// How much stiffer than a cell of the mass the contact points before it are: a surface gives way by a thirtieth of
/// that cell's strain. Conjugate gradients take a third less with ten and half more with a hundred.
inline constexpr double contact_stiffness = 30;

/// The numbers of a step at the contact points, in arrays over them.
struct ContactNumbers {
  double* spring;       ///< stiffness, as far as the place is filled [N/m]
  double* coefficient;  ///< of friction
  double* limit;  ///< what holds slip, for the push found last: held while Newton goes on, so that the force has a
                  ///< potential [N]
  Sym3<double>* stiffness;  ///< minus the force's derivative by the displacement [N/m]
  double modulus;           ///< of the springs under a full layer, over area [Pa/m]
};

/// The nodes' masses, for ContactView::around.
template <class Real>
struct NodeMass {
  const double* data;
  TALUS_HD Real mass(int n) const { return static_cast<Real>(data[n]); }  ///< mass of stored node n [kg]
};

/// One thread: one contact point. It measures the mass before it, and the limit of friction that the step begins with.
template <class Real, class Shape>
struct MeasureGrip {
  GridView<Real> grid;
  ContactView<Real> contacts;
  NodeArrays nodes;
  double layer_mass;  ///< of a full layer over a square metre [kg/m2]
  ContactNumbers numbers;
  TALUS_HD void operator()(int c) const {
    const NodeMass<Real> masses{nodes.mass};
    const Real mass = contacts.template mass_before<Shape>(grid, masses, c);
    contacts.inverse_mass[c] = mass > Real(0) ? Real(1) / mass : Real(0);
    if (!(mass > Real(0))) {
      contacts.force[c] = {};
      return;
    }
    const Vec3<double> normal = widen(contacts.normal[c]);
    const double filled = static_cast<double>(contacts.filled(grid, c, layer_mass)),
                 area = static_cast<double>(contacts.area[c]);
    numbers.spring[c] = numbers.modulus * area * filled;
    numbers.coefficient[c] = static_cast<double>(contacts.friction(c));
    numbers.limit[c] = numbers.coefficient[c] * dot(contacts.force[c], normal);
  }
};

/// The force (T12b) of contact point c for a displacement of the grid; with `stiffness`, minus its derivative too.
template <class Real>
TALUS_HD Vec3<double> contact_force(const ContactView<Real>& contacts, const ContactNumbers& numbers, int c,
                                    const Vec3<double>& u, Sym3<double>* stiffness) {
  const double k = numbers.spring[c];
  const Vec3<double> n = widen(contacts.normal[c]), required = contacts.force[c] - u * k;
  const double push = dot(required, n);
  if (push < 0) {
    if (stiffness) *stiffness = {};
    return {};
  }
  const Vec3<double> along = required - n * push;
  const double size = length(along), limit = numbers.limit[c];
  if (size <= limit) {
    if (stiffness) *stiffness = Sym3<double>{k, k, k, 0, 0, 0};
    return required;
  }
  const Vec3<double> t = along * (1 / size);
  if (stiffness) {
    const double s = k * limit / size;  // across the slip; none along it
    const auto entry = [&](double na, double nb, double ta, double tb, double same) {
      return k * na * nb + s * (same - na * nb - ta * tb);
    };
    *stiffness = Sym3<double>{entry(n.x, n.x, t.x, t.x, 1), entry(n.y, n.y, t.y, t.y, 1), entry(n.z, n.z, t.z, t.z, 1),
                              entry(n.x, n.y, t.x, t.y, 0), entry(n.y, n.z, t.y, t.z, 0), entry(n.x, n.z, t.x, t.z, 0)};
  }
  return n * push + t * limit;
}

/// The displacement of contact point c, from the nodes' u [m].
template <class Real, class Shape>
TALUS_HD Vec3<double> contact_move(const GridView<Real>& grid, const ContactView<Real>& contacts, const double* mass,
                                   const Vec3<double>* u, int c) {
  Vec3<double> sum{};
  contacts.template around<Shape>(grid, NodeMass<Real>{mass}, c,
                                  [&](int n, Real share) { sum += u[n] * static_cast<double>(share); });
  return sum;
}
/// This function adds a force [N] at contact point c to the nodes around it, by their shares.
template <class Real, class Shape>
TALUS_HD void spread(const GridView<Real>& grid, const ContactView<Real>& contacts, const double* mass, int c,
                     const Vec3<double>& force, Vec3<double>* nodes) {
  contacts.template around<Shape>(grid, NodeMass<Real>{mass}, c, [&](int n, Real share) {
    scatter_add(&nodes[n], force * static_cast<double>(share));
  });
}

/// One thread: one contact point. Its force for the displacement u is subtracted from the internal force.
template <class Real, class Shape>
struct ScatterContacts {
  GridView<Real> grid;
  ContactView<Real> contacts;
  NodeArrays nodes;
  ContactNumbers numbers;
  bool with_stiffness;
  TALUS_HD void operator()(int c) const {
    if (with_stiffness) numbers.stiffness[c] = {};
    if (!(contacts.inverse_mass[c] > Real(0))) return;
    const Vec3<double> u = contact_move<Real, Shape>(grid, contacts, nodes.mass, nodes.u, c);
    const Vec3<double> force = contact_force(contacts, numbers, c, u, with_stiffness ? &numbers.stiffness[c] : nullptr);
    if (dot(force, force) > 0) spread<Real, Shape>(grid, contacts, nodes.mass, c, force * -1.0, nodes.internal);
  }
};

/// One thread: one contact point. The limit of friction follows the push for the displacement u, the force the limit.
template <class Real, class Shape>
struct RenewLimits {
  GridView<Real> grid;
  ContactView<Real> contacts;
  NodeArrays nodes;
  ContactNumbers numbers;
  TALUS_HD void operator()(int c) const {
    if (!(contacts.inverse_mass[c] > Real(0))) return;
    const Vec3<double> u = contact_move<Real, Shape>(grid, contacts, nodes.mass, nodes.u, c);
    const Vec3<double> before = contact_force(contacts, numbers, c, u, nullptr);
    const double push = dot(before, widen(contacts.normal[c]));
    numbers.limit[c] = push > 0 ? numbers.coefficient[c] * push : 0;
    const Vec3<double> change = contact_force(contacts, numbers, c, u, &numbers.stiffness[c]) - before;
    if (dot(change, change) > 0) spread<Real, Shape>(grid, contacts, nodes.mass, c, change * -1.0, nodes.internal);
  }
};

/// One thread: one contact point. It adds K x of its spring to y.
template <class Real, class Shape>
struct ApplyContacts {
  GridView<Real> grid;
  ContactView<Real> contacts;
  const double* mass;
  const Sym3<double>* stiffness;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int c) const {
    if (trace(stiffness[c]) == 0) return;
    spread<Real, Shape>(grid, contacts, mass, c, stiffness[c] * contact_move<Real, Shape>(grid, contacts, mass, x, c),
                        y);
  }
};

/// One thread: one contact point. It adds its part of the diagonal, for preconditioners.
template <class Real, class Shape>
struct AddContactDiagonal {
  GridView<Real> grid;
  ContactView<Real> contacts;
  const double* mass;
  const Sym3<double>* stiffness;
  Sym3<double>* diagonal;
  TALUS_HD void operator()(int c) const {
    const Sym3<double> k = stiffness[c];
    if (trace(k) == 0) return;
    contacts.template around<Shape>(grid, NodeMass<Real>{mass}, c, [&](int n, Real share) {
      const double w = static_cast<double>(share) * static_cast<double>(share);
      double* const sum = &diagonal[n].xx;
      const double part[6] = {k.xx * w, k.yy * w, k.zz * w, k.xy * w, k.yz * w, k.xz * w};
      for (int q = 0; q < 6; ++q) scatter_add(&sum[q], part[q]);
    });
  }
};

/// One thread: one contact point. It keeps force and impulse of an accepted step.
template <class Real, class Shape>
struct KeepContacts {
  GridView<Real> grid;
  ContactView<Real> contacts;
  NodeArrays nodes;
  ContactNumbers numbers;
  double step;
  const Vec3<Real>* arrival;  ///< impulse with which the surface met the mass at once; null in statics [N s]
  TALUS_HD void operator()(int c) const {
    if (!(contacts.inverse_mass[c] > Real(0))) return;
    const Vec3<double> u = contact_move<Real, Shape>(grid, contacts, nodes.mass, nodes.u, c);
    contacts.force[c] = contact_force(contacts, numbers, c, u, nullptr);
    contacts.impulse[c] += contacts.force[c] * step;
    if (arrival) contacts.impulse[c] += widen(arrival[c]);
  }
};

/// The nodes of an implicit step, for what surfaces take from them at once (see PrepareNodes::arrive).
template <class Real>
struct ArrivingNodes {
  NodeArrays nodes;
  double step;  ///< where the first guess of the displacement goes with the velocity [s]; else 0
  TALUS_HD Real mass(int n) const { return static_cast<Real>(nodes.mass[n]); }  ///< mass of stored node n [kg]
  /// The velocity that node n begins the step with [m/s].
  TALUS_HD Vec3<Real> velocity(int n) const { return narrow<Real>(nodes.begin_velocity(n)); }
  /// The method adds a change of velocity [m/s] to node n, and to the first guess of its displacement.
  TALUS_HD void add(int n, const Vec3<Real>& v) const {
    const Vec3<double> change = widen(v);
    nodes.arrival[n] += change;
    nodes.u[n] += nodes.freed[n] * (change * step);
  }
};

}  // namespace talus::solver
