// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One implicit step: the equations (T16) of its end as Newton's method takes them, and what an accepted step leaves
// with the particles.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/implicit/tangent_system.hpp"
#include "solver/implicit/transfer.hpp"

namespace talus::solver {

/// The place in time where a step begins, and the way in which it does.
struct StepBegin {
  double start = 0, step = 0;           ///< [s]
  bool accelerates = false;             ///< no acceleration is known yet: that of the forces at the start is taken
  bool backward_euler = false;          ///< in place of Newmark's numbers
  const Vec3<double>* loads = nullptr;  ///< force per volume of every load at the end of the step [N/m3]; null: none
  Vec3<double> shaking{};               ///< acceleration of the ground, its mean over the step [m/s2]
  Vec3<double> shaking_before{};        ///< over the step before, which the accelerations at the start know [m/s2]
};

/// A step from its beginning to its end; a NewtonProblem in between.
template <class Real, class Device, class Shape>
class ImplicitStep {
 public:
  using Parts = StepParts<Real, Device, Shape>;

  ImplicitStep(const Parts& parts, DeviceBed<double, Device> bed)
      : parts_(parts),
        balance_(empty_balance(parts.device)),
        contacts_(parts_, nodes_, std::move(bed), &balance_.data()->pull),
        tangent_(parts_, nodes_, contacts_) {}
  ImplicitStep(const ImplicitStep&) = delete;
  ImplicitStep& operator=(const ImplicitStep&) = delete;

  /// The method takes particles that have been sorted and a grid that is fitted to them; `walls` are there from now on.
  void group(const Walls<double>& walls) {
    walls_ = walls;
    tangent_.group();
  }

  /// The method measures everything that does not change with the displacement: (T3), (T4), loads and contacts. Loads
  /// are those at the end of the step, walls those at its start.
  void begin(const StepBegin& at) {
    const ProfilePhase<Device> phase(parts_.device, "points to grid");
    const ImplicitControls& c = parts_.controls;
    scheme_ = {.dynamic = c.dynamic, .alpha = c.alpha, .beta = c.beta, .step = at.step};
    if (at.backward_euler) scheme_ = {.dynamic = c.dynamic, .alpha = 0.5, .beta = 1, .step = at.step};
    nodes_.resize(parts_.grid.nodes());
    contacts_.resize();
    tangent_.begin(scheme_);
    scatter_points(parts_.device, parts_.points.count(), parts_.grid.groups(),
                   ScatterInertia<Real, Shape>{{parts_.grid.view(), parts_.points.view()},
                                               parts_.materials,
                                               parts_.settings.affine(),
                                               c.dynamic,
                                               at.loads,
                                               nodes()});
    contacts_.begin(scheme_, walls_, gravity_at(at.start + at.step) - at.shaking);
    missed_ = (at.shaking_before - at.shaking) * (at.step * (1 - scheme_.beta));
    if (!c.dynamic) return;
    sum_each<1>(parts_.device, nodes_.count, parts_.sums, SquareMomentum{nodes()},
                KeepTotals<1>{&balance_.data()->momentum});
    // Newton's iterations begin where these velocities lead; the one solve begins at rest, and has to be told.
    if (c.once()) for_each(parts_.device, nodes_.count, LookAhead{nodes(), at.step, nodes_.ahead.data()});
    if (at.accelerates || parts_.settings.damping > 0) begin_forces(at.accelerates);
  }

  /// The method makes Newton's iterations, or the one linear solve; see NewtonReport.
  NewtonReport solve() {
    return parts_.controls.once() ? solve_once(*this, parts_.controls) : newton(*this, parts_.controls);
  }

  // The verbs of NewtonProblem.

  /// The method measures forces and tangent for the present u.
  void measure(Linearisation linearisation) { tangent_.measure(linearisation); }

  /// The method measures the unbalanced force r(u) of (T16), under contacts as they are or decided anew.
  Unbalanced residual(Contacts contacts) {
    const ProfilePhase<Device> phase(parts_.device, "residual and contact");
    const bool decide = contacts == Contacts::decided;
    if (decide) {
      contacts_.renew_limits();
      const double each = parts_.controls.tolerance / std::sqrt(static_cast<double>(std::max(nodes_.count, 1)));
      sum_each<1>(parts_.device, nodes_.count, parts_.sums, SquareForces{nodes()},
                  FinishForces{balance_.data(), scheme_.stopping_share(), each});
    }
    sum_each<3>(parts_.device, nodes_.count, parts_.sums,
                MeasureResidual{.contacts = {nodes(), contacts_.constraints(), scheme_},
                                .decide = decide,
                                .change = decide ? nullptr : nodes_.change.data()},
                FinishResidual{balance_.data()});
    const Balance balance = balance_.download().front();
    return {.force = std::sqrt(balance.residual),
            .size = force_size(balance, scheme_.stopping_share()),
            .along = balance.along,
            .downhill = std::abs(balance.downhill),
            .changed = balance.changes > 0};
  }

  /// The method solves the linear system (T19) for the change of u, to a relative residual of `tolerance`.
  LinearReport solve(double tolerance) { return tangent_.solve(nodes_.residual, nodes_.change, tolerance); }

  /// The method keeps u as the place where a line search begins. The host hears of |r . change| there with the next
  /// residual, and does not wait for it.
  void begin_search() {
    sum_each<1>(parts_.device, nodes_.count, parts_.sums,
                BeginSearch{.u = nodes_.u.data(),
                            .residual = nodes_.residual.data(),
                            .change = nodes_.change.data(),
                            .saved = nodes_.saved_u.data()},
                KeepTotals<1>{&balance_.data()->downhill});
  }
  void apply_change(double share) { axpby(share, nodes_.change, 1.0, nodes_.u); }
  void return_to_start() { copy(nodes_.saved_u, nodes_.u); }  ///< sets u to what it was at begin_search()
  /// The method makes slipping contacts that u takes back stick.
  void stick_reversed() { contacts_.stick_reversed(balance_.data()); }

  /// How far the farthest point moves for u; waits for the device.
  Motion farthest_motion() {
    farthest_.upload({0});
    for_each(parts_.device, parts_.points.count(),
             MeasureMotion<Real, Shape>{.grid = parts_.grid.view(),
                                        .points = parts_.points.view(),
                                        .u = nodes_.u.data(),
                                        .dynamic = parts_.controls.dynamic,
                                        .farthest = farthest_.data()});
    const auto cells = static_cast<double>(positive_from_bits(farthest_.download().front()));
    return {.share = cells, .length = cells * std::min(parts_.cell.spacing, parts_.cell.layer_height)};
  }
  /// The smoothing of friction, kept from step to step.
  FrictionSmoothing& smoothing() { return contacts_.smoothing(); }

  /// Takes the particles to the end of the step. `kept`: share of their velocity finer than the grid that stays.
  void accept(Clock* clock, double kept) {
    contacts_.keep(scheme_.step);
    for_each(parts_.device, nodes_.count,
             EndOfStep{nodes(), scheme_, nodes_.velocity_end.data(), nodes_.acceleration_end.data(), missed_});
    with_laws_of(parts_.materials,
                 [&]<class Laws>(const Materials<Real, Laws>& materials) { accept_points(materials, clock, kept); });
  }

  /// The method records thickness and arrival of the step that ends at `time` [s].
  void record_maps(const MapView& maps, double time, const ColumnDensity<Real>& density) {
    for_each(parts_.device, parts_.grid.active_blocks() * block_columns,
             RecordColumns<Real>{.grid = parts_.grid.view(),
                                 .active = parts_.grid.active_list(),
                                 .mass = nodes_.mass.data(),
                                 .density = density,
                                 .time = time,
                                 .maps = maps});
  }

  /// The method calls add(name, bytes) for each of its parts.
  template <class Add>
  void list_memory(Add&& add) const {
    add("nodes", nodes_.bytes());
    add("bed and walls", contacts_.node_bytes());
    if (parts_.surfaces.on()) add("contact forces", contacts_.point_bytes());
    tangent_.list_memory(add);
  }

 private:
  static Buffer<Balance, Device> empty_balance(const Device& device) {
    Buffer<Balance, Device> balance(device);
    balance.upload({Balance{}});
    return balance;
  }
  /// Gravity at a time [m/s2].
  Vec3<double> gravity_at(double time) const {
    const double ramp = parts_.settings.gravity_ramp;
    return parts_.settings.gravity_vector() * (ramp > 0 ? std::min(1.0, time / ramp) : 1.0);
  }
  NodeArrays nodes() { return nodes_.arrays(parts_.controls.dynamic); }

  /// The method takes acceleration and damping from the forces at the start of the step.
  void begin_forces(bool accelerates) {
    copy(nodes_.u, nodes_.saved_u);
    nodes_.u.fill_zero();
    tangent_.measure_forces();
    if (accelerates) for_each(parts_.device, nodes_.count, FirstAcceleration{nodes()});
    if (parts_.settings.damping > 0)
      for_each(parts_.device, nodes_.count, AddDamping{nodes(), parts_.settings.damping});
    copy(nodes_.saved_u, nodes_.u);
  }

  template <class Laws>
  void accept_points(const Materials<Real, Laws>& materials, Clock* clock, double kept) {
    const bool dynamic = parts_.controls.dynamic;
    AcceptStep<Real, Shape, Laws> kernel{.grid = parts_.grid.view(),
                                         .points = parts_.points.view(),
                                         .materials = materials,
                                         .clock = clock,
                                         .nodes = nodes(),
                                         .end = {.velocity = dynamic ? nodes_.velocity_end.data() : nullptr,
                                                 .acceleration = nodes_.acceleration_end.data()},
                                         .strain_displacement = nodes_.u.data(),
                                         .kept = kept,
                                         .affine = parts_.settings.affine(),
                                         .dilatant = parts_.dilatant,
                                         .part = {},
                                         .means = tangent_.stresses().means()};
    if (dynamic && parts_.settings.remaps_velocity()) {
      remap_velocity(kernel);
    } else {
      tangent_.stresses().average(nodes_.u);
    }
    for_each(parts_.device, parts_.points.count(), kernel);
  }

  /// Remaps velocity (MUSL): particles take their velocity first, and their strain from what it makes of the nodes'.
  template <class Laws>
  void remap_velocity(AcceptStep<Real, Shape, Laws>& kernel) {
    kernel.part = {.speeds = true, .deforms = false};
    for_each(parts_.device, parts_.points.count(), kernel);
    nodes_.change.fill_zero();
    scatter_points(parts_.device, parts_.points.count(), parts_.grid.groups(),
                   ScatterVelocity<Real, Shape>{
                       {parts_.grid.view(), parts_.points.view()}, parts_.materials, nodes_.change.data()});
    for_each(parts_.device, nodes_.count, RemapDisplacement{nodes(), scheme_.step, nodes_.change.data()});
    tangent_.stresses().average(nodes_.change);
    kernel.strain_displacement = nodes_.change.data();
    kernel.part = {.speeds = false, .deforms = true};
  }

  Parts parts_;
  NodeFields<Device> nodes_{parts_.device};
  Buffer<Balance, Device> balance_;
  ContactSet<Real, Device, Shape> contacts_;
  TangentSystem<Real, Device, Shape> tangent_;
  NewmarkScheme scheme_;
  Vec3<double> missed_{};  ///< velocity that the shaking gives and Newmark's rule for it does not (T43) [m/s]
  Walls<double> walls_;
  Buffer<std::uint32_t, Device> farthest_{parts_.device};
};

}  // namespace talus::solver
