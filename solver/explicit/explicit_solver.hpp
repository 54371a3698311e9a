// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The explicit step. Included by the files that instantiate it.
#pragma once

#include "solver/integrator/batch_solver.hpp"
#include "solver/integrator/make_solvers.hpp"

namespace talus {

/// The content of the nodes when a column is updated.
enum class NodeContent {
  impulse,  ///< momentum with the internal force's impulse in it
  force     ///< momentum and internal force apart
};

/// The update of the nodes' velocity (T6), damped and slowed by the bed, and with a budget what that takes (T24); a
/// kernel of for_each_column. Mass stays, momentum becomes velocity. With `counts` losses are counted, which wants
/// forces apart.
template <class Real, NodeContent content, bool counts = false>
struct UpdateColumns {
  static_assert(!counts || content == NodeContent::force);
  ColumnBoundary<Real> boundary;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;  ///< in: internal force; out: velocity change of the step (FLIP)
  Real damping;        ///< Cundall's local factor [-]

  /// The memory that the kernel moves [bytes].
  double bytes(int) const {
    return boundary.grid.nodes * static_cast<double>((content == NodeContent::force ? 4 : 2) * sizeof(*nodes));
  }

  using Column = SteppedColumn<Real>;
  /// The sums over the layers of a column: mass [kg], losses.
  struct Sums {
    Real mass = 0;
    LossesIf<counts> losses;
    TALUS_HD Sums& operator+=(const Sums& o) {
      mass += o.mass;
      losses += o.losses;
      return *this;
    }
  };

  TALUS_HD Column locate(int c) const { return boundary.locate(c); }

  TALUS_HD void layer(const Column& at, int k, Sums& sums) const {
    const int n = at.node(k);
    const Vec4<Real> node = nodes[n];
    boundary.next.clear(n);
    if (!(node.w > Real(0))) {
      if (k == at.rise_layer) boundary.columns.rise[at.column] = Real(off_bed);
      return;
    }
    const Vec3<Real> v = update(at, k, n, node, sums.losses);
    nodes[n] = {node.w, v.x, v.y, v.z};
    sums.mass += node.w;
  }

  TALUS_HD void finish(const Column& at, const Sums& sums) const {
    const BedColumns<Real>& columns = boundary.columns;
    if (columns.mass && (at.rise_layer < at.first || at.rise_layer >= at.last)) columns.rise[at.column] = Real(off_bed);
    boundary.finish(at, sums.mass, sums.losses);
  }

 private:
  TALUS_HD Vec3<Real> update(const Column& at, int k, int n, const Vec4<Real>& node, LossesIf<counts>& losses) const {
    const Vec3<Real> g = boundary.gravity.at(*boundary.clock);
    NodeVelocities<Real> v;
    v.before = v.free = {node.x / node.w, node.y / node.w, node.z / node.w};
    Vec3<Real> undamped = v.before;
    if constexpr (content == NodeContent::impulse) v.free += g * at.dt;
    if constexpr (content == NodeContent::force) {
      const Vec4<Real> f = forces[n];
      const Real below = boundary.submersion.share(boundary.grid, at.column, k);
      const Real inertia = node.w * boundary.submersion.inertia(below);
      Vec3<Real> pull =
          (Vec3<Real>{f.x, f.y, f.z} + g * (node.w * boundary.submersion.weight(below))) * (Real(1) / inertia);
      undamped += pull * at.dt;
      if (damping > Real(0)) pull = damped(pull, v.before, damping);
      v.free += pull * at.dt;
    }
    boundary.meet(at, k, node.w, NodeMass<Real>{node.w}, v);
    if constexpr (counts) {
      const Vec3<Real> mean = v.mean();
      losses.take(GivenImpulses<Real>{(v.met - v.free) * node.w, (v.after - v.met) * node.w}, mean,
                  normal_of(boundary.grid.slope_x[at.column], boundary.grid.slope_y[at.column]));
      losses.pass_on(node.w, v.before, v.after);
      if (damping > Real(0)) losses.damping += static_cast<double>(node.w * dot(undamped - v.free, mean));
      losses.add_shaking(node.w, mean, *boundary.clock);
    }
    if constexpr (content == NodeContent::force) {
      const Vec3<Real> change = v.after - v.before;
      forces[n] = {Real(0), change.x, change.y, change.z};
    }
    return v.after;
  }
};

}  // namespace talus

namespace talus::solver {

template <class Real, class Device, class Shape>
class ExplicitSolver final : public BatchSolver<Real, Device, Shape, true> {
  using Base = BatchSolver<Real, Device, Shape, true>;
  using Base::device_, Base::grid_, Base::settings_;

 public:
  ExplicitSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings, const SolverState& state)
      : Base(device, scene, settings, state) {
    this->start(state);
  }

 private:
  void update_nodes() override {
    const NodeInertia<Device> inertia(device_);
    if (!this->forces_apart())
      return this->update(nullptr, inertia, [&] { update_columns<NodeContent::impulse, false>(); });
    this->update(this->forces(), inertia, [&] {
      settings_.energy_budget ? update_columns<NodeContent::force, true>()
                              : update_columns<NodeContent::force, false>();
    });
  }

  template <NodeContent content, bool counts>
  void update_columns() {
    Vec4<Real>* const changes = content == NodeContent::force ? this->forces() : nullptr;
    for_each_column<block_columns>(
        device_, grid_.active_blocks(),
        UpdateColumns<Real, content, counts>{this->boundary(changes), this->nodes(), this->forces(),
                                             static_cast<Real>(settings_.damping)});
  }
};

template <class Real, class Shape>
std::unique_ptr<Solver> ExplicitSolvers<Real, Shape>::make(const Scene& scene, const IntegratorSettings& settings,
                                                           const AnyDevice& device, const SolverState& state) {
  return make_solver_on<ExplicitSolver, Real, Shape>(device, scene, settings, state);
}

}  // namespace talus::solver
