// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of a Newton iteration: stress and tangent of the particles for a displacement of the grid, and the
// change of displacement that the tangent asks for.
#pragma once

#include <algorithm>
#include <type_traits>

#include "solver/implicit/contact_set.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"
#include "solver/linear/operator/tangent_operator.hpp"
#include "solver/linear/preconditioner/preconditioner.hpp"

namespace talus::solver {

/// The particles' tangents in storage with what couples those of an element: f_int of (T16) and its derivative.
template <class Real, class Device, class Shape>
class ParticleStresses {
 public:
  using Parts = StepParts<Real, Device, Shape>;

  /// The constructor keeps references, `mass` to that of the nodes [kg]. Tangents are stored in single precision where
  /// Newton's iterations correct what that rounds off.
  ParticleStresses(const Parts& parts, const Buffer<double, Device>& mass)
      : parts_(parts), mass_(mass), single_(rounds(parts.controls)) {}

  /// Whether tangents are rounded to single precision.
  static bool rounds(const ImplicitControls& c) {
    return std::is_same_v<Real, double> && !c.once() && c.linear_solver != LinearSolver::cholesky;
  }

  /// The method takes particles that have moved or have been sorted: elements and neighbours anew.
  void group() {
    elements_.build(parts_.grid.view(), parts_.points.view());
    if (parts_.controls.b_bar) means_.begin_step(elements_, parts_.points.count());
  }
  /// The method makes room for the tangents of the particles in a step of this duration [s].
  void begin(double duration) {
    duration_ = duration;
    const auto numbers =
        static_cast<std::size_t>(TangentStore<Real>::numbers) * static_cast<std::size_t>(parts_.points.count());
    if (single_) {
      single_tangents_.resize(numbers);
    } else {
      tangents_.resize(numbers);
    }
  }

  /// The method adds f_int of (T16) for the displacement u to `forces`, both [nodes]; it stores the tangents too where
  /// `with_tangent`, without what compression makes negative in them where `definite`. `ahead` is the way that the
  /// nodes are about to go from there, [nodes] on the device, or null (T17c).
  void measure(const NodeVector<Device>& u, NodeVector<Device>& forces, bool with_tangent, bool definite,
               const Vec3<double>* ahead = nullptr) {
    average(u);
    with_laws_of(parts_.materials, [&]<class Laws>(const Materials<Real, Laws>& materials) {
      using Stress = StressAt<Real, Shape, Laws>;
      scatter_points(
          parts_.device, parts_.points.count(), parts_.grid.groups(),
          ScatterForces<Real, Shape, Stress>{{parts_.grid.view(), parts_.points.view()},
                                             Stress{.materials = materials,
                                                    .dilatant = parts_.dilatant,
                                                    .definite = definite,
                                                    .means = means(),
                                                    .tangents = with_tangent ? store() : TangentStore<Real>{},
                                                    .u = u.data(),
                                                    .duration = static_cast<Real>(duration_),
                                                    .ahead = ahead},
                                             forces.data()});
    });
    if (springs().on()) apply_springs(elements_, springs(), u, forces);
  }

  /// The method measures the means of B-bar (T17b) over the elements for a displacement.
  void average(const NodeVector<Device>& u) {
    if (parts_.controls.b_bar)
      means_.measure(elements_, parts_.grid.view(), parts_.points.view(), parts_.materials,
                     {u.data(), duration_, parts_.dilatant});
  }
  /// The means as kernels read them; off without B-bar.
  MeanDilationView<Real> means() const { return parts_.controls.b_bar ? means_.view() : MeanDilationView<Real>{}; }

  /// All that the tangent of a step is summed from.
  PointTangents<Real> view() { return {parts_.grid.view(), parts_.points.view(), store(), means(), springs()}; }
  /// The elements, as they were grouped last.
  const ElementList<Real, Device, Shape>& elements() const { return elements_; }

  /// The size of tangents and means [bytes].
  std::size_t tangent_bytes() const { return tangents_.bytes() + single_tangents_.bytes() + means_.bytes(); }

 private:
  TangentStore<Real> store() { return {tangents_.data(), parts_.points.count(), single_tangents_.data()}; }

  /// The springs (T17a) on nodes with less than a tenth of a full one's mass, in statics.
  FillerSprings springs() const {
    if (parts_.controls.dynamic) return {};
    constexpr double filler = 1e-3;  // of the stiffness of a full cell
    const double h = parts_.cell.spacing, hz = parts_.cell.layer_height;
    const Material<Real>& material = parts_.materials.list[0];
    const double full = static_cast<double>(material.density) * h * h * hz;
    return {.mass = mass_.data(),
            .light = 0.1 * full,
            .stiffness = filler * 2 * static_cast<double>(material.shear_modulus) * std::min(h, hz)};
  }

  const Parts& parts_;
  const Buffer<double, Device>& mass_;
  bool single_;
  double duration_ = 0;  ///< of the step [s]
  ElementList<Real, Device, Shape> elements_{parts_.device};
  MeanDilation<Real, Device, Shape> means_{parts_.device};
  Buffer<Real, Device> tangents_{parts_.device};
  Buffer<float, Device> single_tangents_{parts_.device};
};

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

  /// Takes particles that have moved or have been sorted: elements and neighbours anew, where anything goes by them.
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
