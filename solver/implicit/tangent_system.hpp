// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of a Newton iteration: forces and tangent for a displacement, and the change of displacement that
// the tangent asks for.
#pragma once

#include "solver/implicit/contact_set.hpp"
#include "solver/implicit/line_search.hpp"
#include "solver/implicit/particle_stresses.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"
#include "solver/linear/operator/tangent_operator.hpp"
#include "solver/linear/preconditioner/preconditioner.hpp"

namespace talus::solver {

/// Statics on few points per cell leaves modes of the splines that no point's gradient sees: the share of the diagonal
/// that holds them in a factorisation. The change it makes to a step is undone by the next Newton iteration.
inline constexpr double static_shift = 1e-12;

/// The tangent K of the particles with inertia and contacts, A of (T19), and the solvers that invert it.
template <class Real, class Device, class Shape>
class TangentSystem {
 public:
  using Parts = StepParts<Real, Device, Shape>;

  TangentSystem(const Parts& parts, NodeFields<Device>& nodes, ContactSet<Real, Device, Shape>& contacts)
      : parts_(parts),
        nodes_(nodes),
        contacts_(contacts),
        stresses_(parts, nodes.mass),
        operator_(parts.device),
        preconditioner_(parts.device) {}

  /// The method takes particles that have moved or have been sorted: elements and neighbours anew, where anything goes
  /// by them.
  void group() {
    if (parts_.controls.dynamic && !direct() && !parts_.controls.b_bar) return;
    stresses_.group();
    if (direct()) {
      cholesky_.begin_step(stresses_.elements());
    } else {
      operator_.begin_step(stresses_.elements());
    }
  }
  /// The method makes room for the tangents, and takes the scheme of the step.
  void begin(const NewmarkScheme& scheme) {
    scheme_ = scheme;
    stresses_.begin(scheme.step);
  }

  /// The method measures the internal force for the displacement u, less that of the contact points.
  void measure_forces() { measure(false, false); }
  /// The method measures the same force with its tangent.
  void measure(Linearisation linearisation) { measure(true, linearisation == Linearisation::definite); }

  /// The method solves A x = b, (T19), for the tangent measured last, to a relative residual of `tolerance` unless it
  /// is factorised; x and b [nodes].
  LinearReport solve(const NodeVector<Device>& b, NodeVector<Device>& x, double tolerance) {
    if (direct()) return cholesky_.solve(stresses_.view(), held_nodes(), b, x);
    refresh();
    const ProfilePhase<Device> phase(parts_.device, "conjugate gradients");
    const KrylovLimits limits{
        .tolerance = tolerance, .iterations = parts_.controls.linear_iterations, .give_up = parts_.controls.give_up};
    return cg_.solve(Product{*this}, preconditioner_, b, x, limits);
  }

  /// The stresses of the particles and what they are made with.
  ParticleStresses<Real, Device, Shape>& stresses() { return stresses_; }

  /// The method calls add(name, bytes) for each of its parts.
  template <class Add>
  void list_memory(Add&& add) const {
    add("tangents", stresses_.tangent_bytes());
    add("elements", stresses_.elements().bytes());
    add("preconditioner", preconditioner_.bytes());
    add("Krylov vectors", cg_.bytes());
    add("factor and its matrix", cholesky_.bytes() + static_cast<std::size_t>(cholesky_.factor().factor_bytes()));
  }

 private:
  /// The tangent as conjugate gradients take it; see LinearOperator.
  struct Product {
    TangentSystem& system;
    /// The product with particles and contact points.
    void add_product(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted) {
      system.operator_.apply(x, y, halted);
      system.contacts_.apply(x, y);
    }
    /// The kernel that completes the product with inertia and friction.
    CloseProduct closing(const NodeVector<Device>& x, NodeVector<Device>& y) {
      return {.nodes = system.nodes_.arrays(system.parts_.controls.dynamic),
              .held = system.contacts_.constraints(),
              .inertia = system.scheme_.inertia(),
              .x = x.data(),
              .y = y.data()};
    }
  };

  bool direct() const { return parts_.controls.linear_solver == LinearSolver::cholesky; }

  void measure(bool with_tangent, bool definite) {
    const ProfilePhase<Device> phase(parts_.device, "stress and tangent");
    nodes_.internal.fill_zero();
    const bool looks_ahead = with_tangent && parts_.controls.dynamic && parts_.controls.once();
    stresses_.measure(nodes_.u, nodes_.internal, with_tangent, definite, looks_ahead ? nodes_.ahead.data() : nullptr);
    contacts_.scatter(with_tangent);
  }

  /// The part of the diagonal beside the particles' stiffness.
  HeldNodes held_nodes() {
    return {.count = nodes_.count,
            .mass = nodes_.mass.data(),
            .freed = nodes_.freed.data(),
            .inertia = scheme_.inertia(),
            .shift = parts_.controls.dynamic ? 0 : static_shift,
            .stiffness = contacts_.measure_stiffness()};
  }

  void refresh() {
    const ProfilePhase<Device> phase(parts_.device, "operator and preconditioner");
    preconditioner_.refresh(stresses_.view(), parts_.grid.groups(), stresses_.elements(), held_nodes());
    operator_.refresh(stresses_.view(), parts_.grid.groups());
  }

  const Parts& parts_;
  NodeFields<Device>& nodes_;
  ContactSet<Real, Device, Shape>& contacts_;
  NewmarkScheme scheme_;
  ParticleStresses<Real, Device, Shape> stresses_;
  TangentOperator<Real, Device, Shape> operator_;
  NodePreconditioner<Real, Device, Shape> preconditioner_;
  ConjugateGradient<Device> cg_{parts_.device};
  CholeskySolver<Real, Device, Shape> cholesky_{parts_.device};
};

}  // namespace talus::solver
