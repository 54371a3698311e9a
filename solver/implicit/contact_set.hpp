// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the objects of an implicit step work on together, and its contacts: of the nodes with bed and walls, and of the
// contact points between nodes.
#pragma once

#include <algorithm>

#include "solver/grid/sparse_grid.hpp"
#include "solver/implicit/contact_forces.hpp"
#include "solver/implicit/newton.hpp"
#include "solver/implicit/prepare_nodes.hpp"
#include "solver/integrator/device_state.hpp"

namespace talus::solver {

/// The size of the cells and what they hold when they are full.
struct CellMeasures {
  double spacing, layer_height;  ///< [m]
  double layer_mass;             ///< of a full layer over a square metre [kg/m2]
  double full_base;              ///< mass of a base node under a full layer [kg]
};

/// The particles, the grid and what the mass can touch, which belong to the integrator, the settings of all
/// integrators and the controls of implicit ones.
template <class Real, class Device, class Shape>
struct StepParts {
  Device device;
  const IntegratorSettings& settings;
  const ImplicitControls& controls;
  Particles<Real, Device>& points;
  SparseGrid<Real, Device>& grid;
  Materials<Real>& materials;
  bool dilatant;  ///< plastic flow changes the volume
  SurfaceContact<Real, Device, Shape>& surfaces;
  ContactImpulses<Real, Device, Shape>& impulses;
  SumSpace<Device>& sums;
  CellMeasures cell;
};

/// The buffers of contacts over the stored nodes, sized together; see Constraints for what they hold.
template <class Device>
struct NodeContactFields {
  explicit NodeContactFields(const Device& on) : device(on) {}

  Device device;
  Buffer<Sym3<double>, Device> walls{device};
  NodeVector<Device> normal{device}, direction{device}, way{device};
  Buffer<double, Device> friction{device}, traction{device}, limit{device};
  Buffer<ContactChanges, Device> changes{device};

  /// The method sets the number of nodes. `traction`, `way`: whether those are there.
  void resize(std::size_t nodes, bool has_traction, bool has_way) {
    walls.resize(nodes);
    normal.resize(nodes);
    direction.resize(nodes);
    if (has_way) way.resize(nodes);
    friction.resize(nodes);
    if (has_traction) traction.resize(nodes);
    limit.resize(nodes);
    changes.resize(nodes);
  }
  std::size_t bytes() const { return bytes_of(walls, normal, direction, way, friction, traction, limit, changes); }
};

/// The buffers of contacts over the contact points, sized together; see ContactNumbers for what they hold.
template <class Device>
struct ContactPointFields {
  explicit ContactPointFields(const Device& device)
      : spring(device), coefficient(device), limit(device), stiffness(device) {}

  Buffer<double, Device> spring, coefficient, limit;
  Buffer<Sym3<double>, Device> stiffness;

  /// The method sets the number of contact points; their stiffness begins at zero.
  void resize(std::size_t points) {
    for (auto* b : {&spring, &coefficient, &limit}) b->resize(points);
    stiffness.resize_zeroed(points);
  }
  std::size_t bytes() const { return bytes_of(spring, coefficient, limit, stiffness); }
};

/// The nodes of an implicit step before its beginning, as drag of the bed sees them: mass [kg], momentum [kg m/s], and
/// the velocity that they get at once [m/s]; null in statics, where nothing drags.
struct MomentumNodes {
  using Number = double;
  const double* data;
  const Vec3<double>* momentum;
  Vec3<double>* arrival;
  TALUS_HD double mass(int n) const { return data[n]; }  ///< mass of node n [kg]
  /// The velocity of node n, which has mass [m/s].
  TALUS_HD Vec3<double> velocity(int n) const { return momentum[n] * (1 / data[n]); }
  /// The method adds a change of velocity [m/s] to node n.
  TALUS_HD void add(int n, const Vec3<double>& v) const { arrival[n] += v; }
};

/// The active set of a step and the friction of its members.
template <class Real, class Device, class Shape>
class ContactSet {
 public:
  using Parts = StepParts<Real, Device, Shape>;

  /// The constructor keeps references. `pull`: see Constraints; on the device.
  ContactSet(const Parts& parts, NodeFields<Device>& nodes, DeviceBed<double, Device> bed, const double* pull)
      : parts_(parts), nodes_(nodes), bed_(std::move(bed)), pull_(pull) {
    smoothing_.smooths = parts.controls.dynamic;
  }

  /// The method makes room for the nodes and contact points of a step.
  void resize() {
    fields_.resize(static_cast<std::size_t>(nodes_.count), bed_.view().has_traction(), parts_.controls.once());
  }

  /// The method prepares the nodes at the start of a step of `scheme`: velocities, what holds them, which contacts
  /// stick to begin with, and the first guess of u. `gravity` [m/s2] is that of the step.
  void begin(const NewmarkScheme& scheme, const Walls<double>& walls, const Vec3<double>& gravity) {
    const ImplicitControls& c = parts_.controls;
    const double g = parts_.settings.gravity_size(), dt = scheme.step;
    smoothing_.gravity_way = c.dynamic ? 0.5 * std::max(g, 1e-3) * dt * dt : 1e-4 * parts_.cell.spacing;
    const bool predicts = c.dynamic && !c.once();
    if (traction_.acts() || traction_.measures()) meet_columns(scheme, gravity);
    for_each(parts_.device, parts_.grid.active_blocks() * block_columns,
             PrepareNodes<Real>{.grid = parts_.grid.view(),
                                .active = parts_.grid.active_list(),
                                .nodes = nodes(),
                                .held = constraints(),
                                .walls = walls,
                                .base = traction_.seen_by(bed_.view()),
                                .full_base = parts_.cell.full_base,
                                .gravity = gravity,
                                .scheme = scheme,
                                .columns = traction_.columns(),
                                .predict = predicts});
    if (parts_.surfaces.on()) begin_points(dt, predicts);
  }

  /// The constraints of the nodes as kernels see them.
  Constraints constraints() {
    return {.walls = fields_.walls.data(),
            .normal = fields_.normal.data(),
            .friction = fields_.friction.data(),
            .traction = fields_.traction.data(),
            .limit = fields_.limit.data(),
            .direction = fields_.direction.data(),
            .way = fields_.way.data(),
            .changes = fields_.changes.data(),
            .slip = smoothing_.slip(),
            .head_start = smoothing_.head_start(),
            .pull = pull_};
  }

  /// The method lets the limit of friction at the contact points follow their push.
  void renew_limits() {
    if (parts_.surfaces.on())
      each_point(RenewLimits<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes(), numbers()});
  }
  /// Makes slips that u has turned back stick, there and where the line search set out; `balance` counts them.
  void stick_reversed(Balance* balance) {
    sum_each<1>(parts_.device, nodes_.count, parts_.sums, StickReversed{nodes(), constraints(), nodes_.saved_u.data()},
                FinishReversals{balance});
  }

  /// Subtracts the forces (T12b) of the contact points from the internal force; `with_stiffness` keeps the derivative.
  void scatter(bool with_stiffness) {
    if (parts_.surfaces.on())
      each_point(
          ScatterContacts<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes(), numbers(), with_stiffness});
  }
  /// The method adds K x of the contact points to y, both [nodes].
  void apply(const NodeVector<Device>& x, NodeVector<Device>& y) {
    if (parts_.surfaces.on())
      each_point(ApplyContacts<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes_.mass.data(),
                                            points_.stiffness.data(), x.data(), y.data()});
  }
  /// The method sums the stiffness of friction and of the contact points on the nodes' diagonal, S of (T19) [N/m]; the
  /// array [nodes] is on the device.
  const Sym3<double>* measure_stiffness() {
    stiffness_.resize(static_cast<std::size_t>(nodes_.count));
    for_each(parts_.device, nodes_.count, FrictionStiffness{nodes(), constraints(), stiffness_.data()});
    if (parts_.surfaces.on())
      each_point(AddContactDiagonal<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes_.mass.data(),
                                                 points_.stiffness.data(), stiffness_.data()});
    return stiffness_.data();
  }

  /// The method keeps force and impulse of the contact points in an accepted step of `step` seconds.
  void keep(double step) {
    if (parts_.surfaces.on())
      each_point(KeepContacts<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes(), numbers(), step,
                                           parts_.controls.dynamic ? parts_.impulses.impulses() : nullptr});
  }

  FrictionSmoothing& smoothing() { return smoothing_; }  ///< smoothing of friction, kept from step to step
  /// The size of what the nodes' contacts take [bytes].
  std::size_t node_bytes() const { return bytes_of(bed_, traction_, fields_, stiffness_); }
  std::size_t point_bytes() const { return points_.bytes(); }  ///< size of what the contact points take [bytes]

 private:
  NodeArrays nodes() { return nodes_.arrays(parts_.controls.dynamic); }
  template <class Kernel>
  void each_point(const Kernel& kernel) {
    parts_.surfaces.each(kernel);
  }

  /// The method measures the columns, and lets the bed's drag slow them as they begin a step (T13a). Yield and cohesion
  /// are left to the contacts, whose friction they join: what they hold does not creep.
  void meet_columns(const NewmarkScheme& scheme, const Vec3<double>& gravity) {
    const StepColumns<Real, MomentumNodes> at{
        .grid = parts_.grid.view(),
        .active = parts_.grid.active_list(),
        .blocks = parts_.grid.active_blocks(),
        .nodes = {nodes_.mass.data(), nodes_.velocity.data(), nodes_.arrival.data()},
        .step = {nullptr, scheme.step, {gravity}}};
    traction_.measure(parts_.device, at, bed_.view(), gravity, scheme.step);
    if (scheme.dynamic && bed_.view().has_drag())
      traction_.slow(parts_.device, at, bed_.view(), false,
                     {static_cast<double>(parts_.materials.list[0].density), nullptr});
  }

  /// The method measures friction of the contact points for this step, and what they take at once.
  void begin_points(double step, bool predicts) {
    points_.resize(static_cast<std::size_t>(parts_.surfaces.count()));
    each_point(MeasureGrip<Real, Shape>{parts_.grid.view(), parts_.surfaces.view(), nodes(), parts_.cell.layer_mass,
                                        numbers()});
    if (!parts_.controls.dynamic) return;
    parts_.impulses.run(parts_.surfaces, parts_.grid.view(), ArrivingNodes<Real>{nodes(), predicts ? step : 0},
                        nodes_.count, NodeInertia<Device>(parts_.device), {nullptr, step, true, false});
  }
  ContactNumbers numbers() {
    const Material<Real>& material = parts_.materials.list[0];
    const double wave = static_cast<double>(material.wave_speed);
    const double modulus = static_cast<double>(material.density) * wave * wave;  // of uniaxial strain
    return {.spring = points_.spring.data(),
            .coefficient = points_.coefficient.data(),
            .limit = points_.limit.data(),
            .stiffness = points_.stiffness.data(),
            .modulus = contact_stiffness * modulus / std::min(parts_.cell.spacing, parts_.cell.layer_height)};
  }

  const Parts& parts_;
  NodeFields<Device>& nodes_;
  DeviceBed<double, Device> bed_;
  const double* pull_;
  FrictionSmoothing smoothing_;
  ColumnTraction<double, Device> traction_{parts_.device, bed_.view(), parts_.grid.shape().columns,
                                           parts_.grid.shape().rows};
  NodeContactFields<Device> fields_{parts_.device};
  ContactPointFields<Device> points_{parts_.device};
  Buffer<Sym3<double>, Device> stiffness_{parts_.device};
};

}  // namespace talus::solver
