// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What explicit and column-implicit integrators share: batches of steps on the device, sorts between them, and a step
// in three verbs. Written once for both devices, both precisions and all shapes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "solver/integrator/column_boundary.hpp"
#include "solver/integrator/column_contact.hpp"
#include "solver/integrator/point_solver.hpp"
#include "solver/transfer/grid_to_particle.hpp"
#include "solver/transfer/particle_to_grid.hpp"

namespace talus::solver {

/// The steps between sorts on a GPU: order within cells gains it little, and sorting takes as long as ten steps.
inline constexpr int gpu_steps_between_sorts = 256;
/// The same where points are split at sorts: a flow should not be drawn out much in between.
inline constexpr int gpu_steps_between_splits = 64;
/// The steps between sorts where many points keep a GPU busy: what lies apart costs more than sorting then.
inline constexpr int busy_gpu_steps_between_sorts = 32;
/// The steps between sorts on a GPU for a number of points: `busy_gpu_steps_between_sorts` where many points have wide
/// stencils.
template <class Shape>
int steps_between_sorts_on_gpu(int points) {
  return Shape::width > 2 && points >= points_that_keep_a_gpu_busy ? busy_gpu_steps_between_sorts
                                                                   : gpu_steps_between_sorts;
}
/// The steps between sorts on a CPU: in places of memory that lie apart, steps become slower.
inline constexpr int cpu_steps_between_sorts = 32;
/// The least and the most way that points on a GPU may go before they are sorted. A sort takes as long as a dozen steps
/// of a small scene; for more way, more empty columns and layers are stored and gone through in every step.
inline constexpr Drift least_drift{.columns = 6, .layers = 3}, most_drift{.columns = 16, .layers = 16};
/// The steps between sorts that the drift on a GPU is to allow.
inline constexpr int steps_worth_a_sort = 24;

/// The drift after `steps` steps that ended because a point went as far as `now` allows: across the layers where it has
/// `climbed`, else along the columns.
inline Drift drift_after(Drift now, int steps, bool climbed) {
  const auto fitted = [steps](int way, int least, int most) {
    return std::clamp(way * steps_worth_a_sort / std::max(steps, 1), least, most);
  };
  if (climbed) {
    now.layers = fitted(now.layers, least_drift.layers, most_drift.layers);
  } else {
    now.columns = fitted(now.columns, least_drift.columns, most_drift.columns);
  }
  return now;
}

inline constexpr int most_batch_steps = 64;  // given to the device before the host looks at the clock

/// An integrator whose steps are bounded by the CFL condition: scatter, update, gather. Derived classes update
/// the nodes; their constructors end with start(). `by_layers`: waves across the layers bound the step.
template <class Real, class Device, class Shape, bool by_layers>
class BatchSolver : public PointSolver<Real, Device, Shape> {
  using Base = PointSolver<Real, Device, Shape>;

 protected:
  using Base::clock_, Base::device_, Base::dilatant_, Base::grid_, Base::loads_, Base::maps_, Base::materials_,
      Base::motion_, Base::points_, Base::settings_, Base::shaking_, Base::surroundings_;

 public:
  BatchSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings, const SolverState& state)
      : Base(device, scene, settings, state, needs(settings), drifts_far(settings) ? least_drift : Drift{}),
        recording_(device),
        columns_(device, surroundings_.bed(), settings, scene.grid, this->submersion()) {}

  /// The method makes a batch of steps on the device, or one step on a CPU; see Solver::advance().
  BatchReport advance() override {
    Clock clock = clock_.read();
    clock.alarms.halt = clock.alarms.request = running;
    clock.steps_ahead = loads_.grow_at(clock.time) ? 1 : steps_ahead(clock);
    clock_.write(clock);
    odd_ = !settings_.remaps_velocity() && clock.sorting.steps_since % 2 != 0;
    walls_ = this->template set_walls<Real>(clock.time);
    loads_now_ = loads_.upload(clock.time, clock.time);
    if (!settings_.walls.empty()) recording_.forget();  // they come, go and move
    clock_.lend();
    for_each(device_, 1, open_step(clock_.room()));
    start_steps(clock);
    BatchReport report;
    clock = clock_.read();
    int halt = clock.alarms.halt;
    this->measured_ = false;
    if (halt == at_event) this->record_motion();
    if (halt == wants_sort) {
      expected_ = clock.sorting.steps_since;
      const int request = clock.alarms.request;
      if (request != running && drifts_far(settings_))
        grid_.set_drift(drift_after(grid_.drift(), expected_, request == climbed));
    }
    // A sort comes before an event of the same time (Clock::halt_where_due), whose records see who has left.
    if (halt == wants_sort || (halt == at_event && clock.outflow.count > 0)) {
      report.outflow_volume = clock.outflow.volume;
      report.outflow_count = clock.outflow.count;
      sort(clock.outflow.count);
      clock.outflow = {};
      clock.sorting = {.steps_since = 0, .steps_between = steps_between_sorts()};  // as in a run resumed here
      clock.alarms.halt = clock.alarms.request = running;
      report.sorted = true;
      if (halt == wants_sort && clock.time >= clock.next_event) {
        clock.halt_where_due();
        halt = clock.alarms.halt;
        this->record_motion();
      }
    }
    clock_.write(clock);
    report.can_be_saved = report.sorted || !Device::is_gpu;
    report.clock = clock;
    report.clock.alarms.halt = halt;
    return report;
  }

  /// All that a checkpoint keeps. On a CPU that is enough to go on between two sorts; see Solver::state().
  SolverState state() const override {
    SolverState now = Base::state();
    if (!Device::is_gpu && now.clock.sorting.steps_since > 0) {
      const std::vector<std::uint64_t> keys = grid_.homes();  // of those who left at the sort as well, last
      now.homes.assign(keys.begin(), keys.begin() + points_.count());
    }
    return now;
  }

  void add(const ParticleState& points, double rate) override {
    points_.append(points);
    Clock clock = clock_.read();
    sort(0);
    clock.sorting = {.steps_since = 0, .steps_between = steps_between_sorts()};
    this->note_points(clock, rate);
    clock_.write(clock);
  }

  MemoryShares memory() const override {
    MemoryShares shares = Base::memory();
    shares.emplace_back("nodes", node_bytes());
    columns_.list_memory(shares);
    return shares;
  }

 protected:
  /// The method gives storage to so many nodes beside their mass, momentum and force.
  virtual void resize_nodes(std::size_t) {}
  virtual void update_nodes() = 0;  ///< once the points are scattered
  /// The memory of the nodes [bytes].
  virtual std::size_t node_bytes() const { return nodes_.bytes(); }
  /// The nodes of the step that is being started, mass and momentum, then velocity; and the forces on them, then the
  /// changes of velocity, null where they are not apart.
  Vec4<Real>* nodes() { return at_nodes(odd_); }
  Vec4<Real>* forces() { return forces_apart() ? at_nodes(odd_, true) : nullptr; }
  /// Whether forces are scattered apart from momentum.
  bool forces_apart() const {
    return !by_layers || settings_.remaps_velocity() || settings_.decay_time > 0 || settings_.damping > 0 ||
           settings_.energy_budget || settings_.submersion.on();
  }

  /// The method sorts the points of the state that the steps begin with.
  void start(const SolverState& state) {
    Clock clock = clock_.read();
    clock.accelerated = 0;
    clock.sorting.steps_between = steps_between_sorts();
    if (state.homes.empty()) clock.outflow = {};  // a sort drops those who have left
    clock_.write(clock);
    const bool as_sorted = Device::is_gpu || state.homes.empty();
    if (!as_sorted) points_.upload(at_home(state, grid_.shape().columns));
    sort(0);
    if (!as_sorted) points_.upload(state.points);
    this->meet_water();
  }

  /// The method scatters the points' mass and momentum, with forces to their own array where it asks for them, and
  /// their motion over the columns where that is due.
  template <Scatter what>
  void scatter() {
    const ProfilePhase<Device> phase(device_, "points to grid");
    const auto kernel = [&]<class Laws>(const Materials<Real, Laws>& materials) {
      return ParticleToGrid<Real, Shape, what, Laws>{grid_.view(), points_.view(), materials,  clock_.data(),
                                                     nodes(),      forces(),       loads_now_, settings_.affine(),
                                                     dilatant_};
    };
    if constexpr (what == Scatter::momentum) {
      scatter_points(device_, points_.count(), grid_.groups(), kernel(materials_));  // asks for no stress
    } else {
      with_laws_of(materials_, [&](const auto& materials) {
        scatter_points(device_, points_.count(), grid_.groups(), kernel(materials), this->sum_of_motion(clock_.data()));
      });
    }
  }

  /// The method makes the grid's part of a step: update_nodes() within what bed and contact points do to whole columns.
  /// `changes` takes the changes of the nodes' velocity; null where the step keeps none.
  template <class Inertia, class UpdateNodes>
  void update(Vec4<Real>* changes, const Inertia& inertia, const UpdateNodes& update_nodes) {
    const StepNodes<Real> at = step_nodes(changes);
    if (flows_) this->flow_water(this->gravity(), loads_now_, nodes());
    this->measure_columns();
    columns_.measure(at, surroundings_.bed());
    {
      const ProfilePhase<Device> phase(device_, "grid");
      update_nodes();
    }
    if (settings_.energy_budget) {  // else ColumnBoundary::finish() holds them
      columns_.count_landing(at);
      columns_.hold(at, walls_, this->column_density().uniform, true);
    }
    meet_surfaces(at, inertia, true);
    columns_.slow(at, surroundings_.bed(), this->column_density());
    if (settings_.erosion_rate > 0) {
      for_each(device_, at.count(),
               ErodeColumns<Real, PackedNodes<Real>>{grid_.view(), grid_.active_list(), at.nodes, clock_.data(),
                                                     this->column_density(), maps_.view(), settings_.erosion_rate});
    }
  }

  /// The surroundings of the columns as the nodes' kernels see them, which hold columns where they count no losses;
  /// `changes` as for update().
  ColumnBoundary<Real> boundary(Vec4<Real>* changes) {
    return {.grid = grid_.view(),
            .active = grid_.active_list(),
            .clock = clock_.data(),
            .gravity = this->gravity(),
            .walls = walls_,
            .friction = columns_.seen_by(surroundings_.bed()),
            .full_base = static_cast<Real>(this->full_base()),
            .columns = columns_.slowed(),
            .pressed = columns_.pressed(),
            .density = this->column_density(),
            .maps = maps_.view(),
            .motion = motion_.sums(),
            .submersion = this->submersion(),
            .nodes = {nodes(), changes},
            .next = {at_nodes(!odd_), forces_apart() ? at_nodes(!odd_, true) : nullptr},
            .holds = !settings_.energy_budget && grid_.view().mapping == Mapping::terrain_following};
  }

 private:
  /// Whether points may go further from home than a cell: a CPU, and sums in order, go by blocks of four columns.
  static bool drifts_far(const IntegratorSettings& settings) { return Device::is_gpu && !settings.deterministic; }
  static ParticleNeeds needs(const IntegratorSettings& settings) {
    ParticleNeeds n = settings.needs;
    n.remapped_velocity = settings.remaps_velocity();
    return n;
  }

  /// The steps to start at once: as many as lead to the next event at their length now, or lay between the last two
  /// sorts, and then a few at a time. Kernels launched after a halt return at once.
  /// On a CPU each step is waited for, and a signal heard after it.
  int steps_ahead(const Clock& clock) const {
    if constexpr (!Device::is_gpu) return 1;
    constexpr int few = 2;
    const SortPolicy& sorting = clock.sorting;
    const int to_sort =
        std::min(std::max(expected_ - sorting.steps_since, few), sorting.steps_between - sorting.steps_since);
    const double to_event = std::ceil((clock.next_event - clock.time) / clock.full_step());
    return std::clamp(static_cast<int>(std::min<double>(to_sort, to_event)), 1, most_batch_steps);
  }

  /// The steps until the next sort, for the points there are.
  int steps_between_sorts() const {
    if constexpr (Device::is_gpu) {
      const int most = settings_.needs.spreads ? gpu_steps_between_splits : gpu_steps_between_sorts;
      return std::min(most, steps_between_sorts_on_gpu<Shape>(points_.count()));
    }
    return cpu_steps_between_sorts;
  }

  /// The method gives the device the steps of a batch. Those in which water flows have kernels that the others go
  /// without.
  void start_steps(const Clock& clock) {
    const int count = clock.steps_ahead;
    for (int n = 0; n < count; ++n) {
      int still = 0;
      while (n + still < count && !clock.water.flows_after(clock.step + n + still)) ++still;
      start_still_steps(still);
      n += still;
      if (n == count) return;
      flows_ = true;
      step();
      flows_ = false;
    }
  }
  /// The method starts steps without water, by two where they take turns with the nodes.
  void start_still_steps(int count) {
    if (odd_ && count > 0) {
      step();
      --count;
    }
    recording_.repeat(count / 2, [&] {
      step();
      step();
    });
    if (count % 2 != 0) step();
  }

  /// The step in three verbs: scatter, update, gather. MUSL maps the points' new momentum back before the stress. Nodes
  /// are scattered to that the step before has cleared.
  void step() {
    if (forces_apart()) {
      scatter<by_layers ? Scatter::force : Scatter::springs>();
    } else if constexpr (by_layers) {
      scatter<Scatter::impulse>();
    }
    update_nodes();
    if (!settings_.remaps_velocity()) return gather<Gather::all>();
    gather<Gather::motion>();
    odd_ = !odd_;
    scatter<Scatter::momentum>();
    remap();
    gather<Gather::deformation>();
  }
  OpenStep open_step(const Clock* from) { return {from, clock_.data(), clock_.room(), shaking_.view()}; }

  /// The place of one of the two sets of nodes that steps take turns with, or of the forces on them.
  Vec4<Real>* at_nodes(bool odd, bool forces = false) {
    return nodes_.data() + static_cast<std::size_t>(grid_.nodes()) * ((forces ? 2U : 0U) + (odd ? 1U : 0U));
  }

  /// The method makes velocities of the points' new momentum.
  void remap() {
    const StepNodes<Real> at = step_nodes(nullptr);
    ColumnBoundary<Real> around = boundary(nullptr);
    if (!around.friction.holds()) around.friction.law = FrictionLaw::none;
    around.columns = {};
    {
      const ProfilePhase<Device> phase(device_, "grid");
      for_each_column<block_columns>(device_, at.blocks, RemapColumns<Real>{around, nodes()});
    }
    columns_.hold(at, walls_, this->column_density().uniform, false);
    meet_surfaces(at, NodeInertia<Device>(device_), false);
  }

  StepNodes<Real> step_nodes(Vec4<Real>* changes) {
    return {.grid = grid_.view(),
            .active = grid_.active_list(),
            .blocks = grid_.active_blocks(),
            .nodes = {nodes(), changes},
            .step = {clock_.data(), 0, {settings_.gravity_vector(), settings_.gravity_ramp}}};
  }

  /// The method lets the nodes meet obstacles, and ground between the nodes (T12a). What is mapped back a second time
  /// (not `first`) is merely kept from running through them.
  template <class Inertia>
  void meet_surfaces(const StepNodes<Real>& at, const Inertia& inertia, bool first) {
    if (!surroundings_.contact().on()) return;
    const ProfilePhase<Device> phase(device_, "contact");
    surroundings_.impulses().run(surroundings_.contact(), at.grid, at.nodes, grid_.nodes(), inertia,
                                 {clock_.data(), 0, first, first});
  }

  template <Gather part>
  void gather() {
    const ProfilePhase<Device> phase(device_, "grid to points");
    const Vec4<Real>* const changes = settings_.decay_time > 0 ? forces() : nullptr;
    const auto run = [&]<bool budget, class Laws>(const Materials<Real, Laws>& materials) {
      const GridToParticle<Real, Shape, part, budget, by_layers, Laws> kernel{
          grid_.view(), points_.view(), materials,          clock_.data(), nodes(),
          changes,      grid_.home(),   settings_.affine(), dilatant_};
      if constexpr (part == Gather::motion) {
        for_each(device_, points_.count(), kernel);
      } else {
        for_each_then(device_, points_.count(), kernel, open_step(clock_.data()));
      }
    };
    if (settings_.energy_budget) {
      run.template operator()<true>(materials_);
    } else if constexpr (part == Gather::motion) {
      run.template operator()<false>(materials_);  // asks for no stress
    } else {
      with_laws_of(materials_, [&](const auto& materials) { run.template operator()<false>(materials); });
    }
    if constexpr (part != Gather::motion) odd_ = !odd_;
  }

  void sort(int outflow_count) {
    const ProfilePhase<Device> phase(device_, "sort and storage");
    recording_.forget();
    this->fit(outflow_count);
    const auto count = static_cast<std::size_t>(grid_.nodes());
    nodes_.resize_zeroed((forces_apart() ? 4 : 2) * count);
    resize_nodes(count);
  }

  Buffer<Vec4<Real>, Device> nodes_{device_};  ///< two sets, then the forces on both where they are apart
  bool odd_ = false;                           ///< the step that is being started has the second set
  Recording<Device> recording_;                ///< of two steps
  int expected_ = 32;                          ///< steps between sorts
  bool flows_ = false;                         ///< water does, in the step that is being started
  Walls<Real> walls_;
  const Vec3<double>* loads_now_ = nullptr;
  ColumnContact<Real, Device> columns_;
};

}  // namespace talus::solver
