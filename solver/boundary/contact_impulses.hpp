// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points in velocities: impulses that let no surface be run through, with friction, found by sweeps over all
// points at once.
//
// With shares M of a point in the nodes (ContactView::around), its velocity is v = sum M_i v_i, and an impulse p there
// changes that by sum M_i^2 / m_i p. In a sweep all points act at once on what the last one left, each divided by the
// sum of what all together do to it, sum_i M_i Q_i with Q_i = sum M_i / m_i over the points (Jacobi's method with
// absolute row sums, which cannot overshoot): a uniform approach is taken away by one sweep. Where an impulse moves
// whole columns (T6c), Q is what it does to them. Forces are kept from step to step (warm start), so that what rests
// stays.
#pragma once

#include "solver/boundary/surface_contact.hpp"
#include "solver/state/clock.hpp"

namespace talus::solver {

inline constexpr int contact_sweeps = 4;

/// The nodes of an explicit step: mass and velocity together.
template <class Real>
struct PackedNodes {
  using Number = Real;
  Vec4<Real>* nodes;
  Vec4<Real>* changes;  ///< of the velocity in the step; null where nothing reads them
  TALUS_HD Real mass(int n) const { return nodes[n].w; }  ///< mass of node n [kg]
  /// The velocity of node n [m/s].
  TALUS_HD Vec3<Real> velocity(int n) const { return {nodes[n].x, nodes[n].y, nodes[n].z}; }
  /// The method adds a change of velocity [m/s] to node n.
  TALUS_HD void add(int n, const Vec3<Real>& v) const {
    nodes[n].x += v.x;
    nodes[n].y += v.y;
    nodes[n].z += v.z;
    if (!changes) return;
    changes[n].x += v.x;
    changes[n].y += v.y;
    changes[n].z += v.z;
  }
};

/// The nodes as an explicit step finds them: mass and momentum together.
template <class Real>
struct PackedMomenta {
  using Number = Real;
  const Vec4<Real>* nodes;
  TALUS_HD Real mass(int n) const { return nodes[n].w; }  ///< mass of node n [kg]
  /// The velocity of node n, which has mass [m/s].
  TALUS_HD Vec3<Real> velocity(int n) const {
    return Vec3<Real>{nodes[n].x, nodes[n].y, nodes[n].z} * (Real(1) / nodes[n].w);
  }
};

/// One thread: one contact point. It measures what mass is before it, and the shares that the points together have in
/// each node; of nodes that are `single`, how much they move it. The impulse of the last step's force acts once more.
template <class Real, class Shape, class Nodes, bool single>
struct BeginContacts {
  GridView<Real> grid;
  ContactView<Real> contacts;
  Nodes nodes;
  const Clock* clock;   ///< null: no history
  Vec3<Real>* impulse;  ///< of this step [N s]
  Vec3<Real>* given;    ///< to the nodes, not yet in their velocity [N s]
  Real* yielding;       ///< of the nodes to all points: Q_i [1/kg], or shares in nodes that are not single

  TALUS_HD void operator()(int c) const {
    if (clock && clock->alarms.halt != running) return;
    const Real mass = contacts.template mass_before<Shape>(grid, nodes, c),
               inverse = mass > Real(0) ? Real(1) / mass : Real(0);
    contacts.inverse_mass[c] = inverse;
    Vec3<Real> p{};
    if (clock && inverse > Real(0)) {
      const Vec3<double> f = contacts.force[c] * clock->step_size;
      p = {static_cast<Real>(f.x), static_cast<Real>(f.y), static_cast<Real>(f.z)};
    }
    impulse[c] = p;
    if (!(inverse > Real(0))) return;
    contacts.template around<Shape>(grid, nodes, c, [&](int n, Real share) {
      talus::scatter_add(&yielding[n], single ? share / nodes.mass(n) : share);
      talus::scatter_add(&given[n], p * share);
    });
  }
};

/// One thread: one contact point. It makes a sweep of (T12a).
template <class Real, class Shape, class Nodes>
struct SweepContacts {
  GridView<Real> grid;
  ContactView<Real> contacts;
  Nodes nodes;
  const Real* yielding;
  const Clock* clock;
  double step;  ///< [s]; the clock's where it has one
  bool grips;   ///< with friction
  bool keeps;   ///< the last sweep of the step: force and impulse are kept
  Vec3<Real>* impulse;
  Vec3<Real>* given;

  TALUS_HD void operator()(int c) const {
    if (clock && clock->alarms.halt != running) return;
    const double dt = clock ? clock->step_size : step;
    Vec3<Real> p{};
    if (contacts.inverse_mass[c] > Real(0)) {
      p = push_back(c);
      const Vec3<Real> before = impulse[c], change = p - before;
      contacts.template around<Shape>(grid, nodes, c,
                                      [&](int n, Real share) { talus::scatter_add(&given[n], change * share); });
      impulse[c] = p;
    }
    if (!keeps) return;
    const Vec3<double> total{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
    contacts.force[c] = total * (1 / dt);
    contacts.impulse[c] += total;
  }

 private:
  /// The impulse of the step at point c, for the velocity that the others leave it.
  TALUS_HD Vec3<Real> push_back(int c) const {
    Vec3<Real> v{};
    Real yield = 0;
    contacts.template around<Shape>(grid, nodes, c, [&](int n, Real share) {
      v += nodes.velocity(n) * share;
      yield += share * yielding[n];
    });
    return ContactView<Real>::hold(impulse[c] - v * (Real(1) / yield), contacts.normal[c],
                                   grips ? contacts.friction(c) : Real(0));
  }
};

/// One thread: one node. It takes the impulse that it was given into its velocity.
template <class Real, class Nodes>
struct TakeImpulses {
  Nodes nodes;
  const Clock* clock;
  Vec3<Real>* given;
  TALUS_HD void operator()(int n) const {
    if (clock && clock->alarms.halt != running) return;
    const Vec3<Real> p = given[n];
    if (p.x == Real(0) && p.y == Real(0) && p.z == Real(0)) return;
    given[n] = {};
    nodes.add(n, p * (Real(1) / nodes.mass(n)));
  }
};

/// Inertia by nodes, for ContactImpulses: an impulse on a node moves that node alone.
template <class Device>
class NodeInertia {
 public:
  static constexpr bool of_single_nodes = true;  ///< contact points work out themselves how much they move a node

  explicit NodeInertia(const Device& device) : device_(device) {}

  /// The method takes the impulses given to `count` nodes [N s] into their velocities, and clears them. Nothing is done
  /// where the clock, if there is one, has halted.
  template <class Nodes, class Real>
  void take(const Nodes& nodes, const Clock* clock, Vec3<Real>* given, int count) const {
    for_each(device_, count, TakeImpulses<Real, Nodes>{nodes, clock, given});
  }

 private:
  Device device_;
};

/// The sweeps (T12a) of a step with their arrays.
template <class Real, class Device, class Shape>
class ContactImpulses {
 public:
  explicit ContactImpulses(const Device& device) : device_(device) {}

  /// The kind of a pass. `clock` null: it is of `step` seconds, and nothing is kept but the impulse. Without `grips`,
  /// and without history, the surfaces are merely kept from being run through.
  struct Pass {
    const Clock* clock;
    double step;
    bool grips, remembers;
  };
  /// Makes the sweeps of a pass over `node_count` nodes, which answer by `inertia` (NodeInertia, ColumnInertia).
  template <class Nodes, class Inertia>
  void run(SurfaceContact<Real, Device, Shape>& contact, const GridView<Real>& grid, const Nodes& nodes, int node_count,
           const Inertia& inertia, const Pass& pass) {
    constexpr bool single = Inertia::of_single_nodes;
    impulse_.resize(static_cast<std::size_t>(contact.count()));
    yielding_.resize_zeroed(static_cast<std::size_t>(node_count));
    if (given_.size() != yielding_.size()) given_.resize_zeroed(yielding_.size());
    const auto take = [&] { inertia.take(nodes, pass.clock, given_.data(), node_count); };
    contact.each(BeginContacts<Real, Shape, Nodes, single>{grid, contact.view(), nodes,
                                                           pass.remembers ? pass.clock : nullptr, impulse_.data(),
                                                           given_.data(), yielding_.data()});
    if constexpr (!single) inertia.yield(yielding_.data());
    if (pass.remembers) take();
    for (int s = 0; s < contact_sweeps; ++s) {
      const bool last = pass.remembers && s + 1 == contact_sweeps;
      contact.each(SweepContacts<Real, Shape, Nodes>{grid, contact.view(), nodes, yielding_.data(), pass.clock,
                                                     pass.step, pass.grips, last, impulse_.data(), given_.data()});
      take();
    }
  }
  /// The impulses of the last pass at the contact points [N s], on the device.
  const Vec3<Real>* impulses() const { return impulse_.data(); }
  std::size_t bytes() const { return impulse_.bytes() + given_.bytes() + yielding_.bytes(); }

 private:
  Device device_;
  Buffer<Vec3<Real>, Device> impulse_{device_}, given_{device_};
  Buffer<Real, Device> yielding_{device_};
};

}  // namespace talus::solver
