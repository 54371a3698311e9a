// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The explicit step, written once for both devices, both precisions and both shapes. Included by the files that
// instantiate it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "solver/explicit/column_contact.hpp"
#include "solver/explicit/column_inertia.hpp"
#include "solver/explicit/ends_of_steps.hpp"
#include "solver/explicit/make_explicit_solver.hpp"
#include "solver/explicit/solve_columns.hpp"
#include "solver/explicit/sort_intervals.hpp"
#include "solver/explicit/update_columns.hpp"
#include "solver/integrator/at_home.hpp"
#include "solver/integrator/point_solver.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/parallel/columns.hpp"
#include "solver/parallel/recording.hpp"
#include "solver/state/shaking.hpp"
#include "solver/transfer/grid_to_particle.hpp"
#include "solver/transfer/particle_to_grid.hpp"

namespace talus::solver {

inline constexpr int most_batch_steps = 64;  // given to the device before the host looks at the clock

/// The integrator of explicit steps: clear, scatter, update, gather.
template <class Real, class Device, class Shape>
class ExplicitSolverOf final : public PointSolver<Real, Device, Shape> {
  using Base = PointSolver<Real, Device, Shape>;
  using Base::clock_, Base::device_, Base::dilatant_, Base::grid_, Base::loads_, Base::maps_, Base::materials_,
      Base::measures_, Base::motion_, Base::points_, Base::settings_, Base::shaking_, Base::surroundings_;

 public:
  ExplicitSolverOf(const Device& device, const Scene& scene, const IntegratorSettings& settings,
                   const SolverState& state)
      : Base(device, scene, settings, state, needs(settings),
             drift_between_sorts<Device>(settings.deterministic, has_company(device))),
        recording_(device, Base::starts_with_others()),
        affine_(settings.transfer.affine),
        musl_(settings.transfer.remaps_velocity),
        keeps_(settings.transfer.time > 0),
        solves_columns_(settings.steps.kappa > 0),
        forces_apart_(musl_ || settings.damping > 0 || keeps_ || settings.energy_budget || solves_columns_),
        softer_(softer(scene, settings)),
        columns_(device, surroundings_.bed(), settings, static_cast<double>(materials_.list[0].density), scene.grid) {
    Clock clock = clock_.read();
    clock.accelerated = 0;
    clock.sorting.steps_between = steps_between_sorts();
    if (state.homes.empty()) clock.outflow.volume = clock.outflow.count = 0;  // a sort drops those who have left
    clock_.write(clock);
    if (Device::is_gpu || state.homes.empty()) {
      sort(0);
    } else {
      points_.upload(at_home(state, scene.grid.columns));
      sort(0);
      points_.upload(state.points);
    }
  }

  /// The method makes a batch of steps on the device, or one step on a CPU; see Solver::advance().
  BatchReport advance() override {
    Clock clock = clock_.read();
    clock.alarms.halt = clock.alarms.request = running;
    clock_.write(clock);
    walls_ = this->template set_walls<Real>(clock.time);
    loads_now_ = loads_.upload(clock.time, clock.time);
    if (!settings_.walls.empty()) recording_.forget();  // they come, go and move
    clock_.lend();
    recording_.repeat(
        steps_ahead(clock), [&] { step(); }, [&] { clock_.pass_in(); }, [&] { close(); });
    BatchReport report;
    clock = clock_.read();
    int halt = clock.alarms.halt;
    this->measured_ = halt == at_event && recording_.has_company();
    if (halt == at_event && !recording_.has_company()) look_back(clock_.data());
    if (halt == wants_sort) expected_ = clock.sorting.steps_since;
    // A sort comes before an event of the same time (Clock::halt_where_due), whose records see who has left.
    if (halt == wants_sort || (halt == at_event && clock.outflow.count > 0)) {
      report.outflow_volume = clock.outflow.volume;
      report.outflow_count = clock.outflow.count;
      sort(clock.outflow.count);
      clock.outflow.volume = 0;
      clock.outflow.count = 0;
      clock.sorting.steps_since = 0;
      clock.sorting.steps_between = steps_between_sorts();  // as a run would have it that goes on from here
      clock.alarms.halt = clock.alarms.request = running;
      report.sorted = true;
      if (halt == wants_sort && clock.time >= clock.next_event) {
        clock.halt_where_due();
        halt = clock.alarms.halt;
        look_back(nullptr);
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

  /// The method adds points; see Solver::add().
  void add(const ParticleState& points, double rate) override {
    points_.append(points);
    Clock clock = clock_.read();
    sort(0);
    clock.sorting.steps_since = 0;
    clock.sorting.steps_between = steps_between_sorts();
    this->note_rate(clock, rate);
    clock_.write(clock);
  }

  /// The memory by its users; see Solver::memory().
  MemoryShares memory() const override {
    MemoryShares shares = Base::memory();
    shares.emplace_back("nodes", nodes_.bytes() + forces_.bytes() + mobilities_.bytes());
    columns_.list_memory(shares);
    return shares;
  }

 private:
  static ParticleNeeds needs(const IntegratorSettings& settings) {
    ParticleNeeds n = settings.needs;
    n.remapped_velocity = settings.transfer.remaps_velocity;
    return n;
  }

  /// The steps to start at once: as many as lead to the next event at their length now, or lay between the last two
  /// sorts, and then a few at a time. What is started after the clock has halted does nothing but take its time.
  /// On a CPU each step is waited for, and a signal heard after it.
  int steps_ahead(const Clock& clock) const {
    if constexpr (!Device::is_gpu) return 1;
    constexpr int few = 2;
    const int to_sort = std::min(std::max(expected_ - clock.sorting.steps_since, few),
                                 clock.sorting.steps_between - clock.sorting.steps_since);
    const double to_event = std::ceil((clock.next_event - clock.time) / clock.full_step());
    return std::clamp(static_cast<int>(std::min<double>(to_sort, to_event)), 1, most_batch_steps);
  }

  /// The steps until the next sort, for the points there are.
  int steps_between_sorts() const {
    if constexpr (Device::is_gpu) return steps_between_sorts_on_gpu<Shape>(points_.count());
    return cpu_steps_between_sorts;
  }

  /// The method ends a batch: it halts where something is due. With other runs it starts what an event asks for at
  /// once, whether or not this is one: that saves a start of its own.
  void close() {
    for_each(device_, 1, CloseBatch{clock_.data()});
    clock_.pass_out();
    if (!recording_.has_company()) return;
    look_back(clock_.data());
    this->start_measures();
  }

  /// The method records the maps of speed and pressure where the clock has halted at an event, or at once where it is
  /// null.
  void look_back(const Clock* clock) {
    this->measure_columns();
    this->sum_motion(clock);
    this->record_motion();
  }

  /// The step in four verbs: clear, scatter, update, gather. MUSL maps the points' new momentum back before the stress.
  void step() {
    clear(true);
    if (solves_columns_) {
      scatter<Scatter::springs>();
      update<NodeContent::force>();
    } else if (forces_apart_) {
      scatter<Scatter::force>();
      update<NodeContent::force>();
    } else {
      scatter<Scatter::impulse>();
      update<NodeContent::impulse>();
    }
    if (!musl_) {
      gather<Gather::all>();
      return;
    }
    gather<Gather::motion>();
    clear(false);
    scatter<Scatter::momentum>();
    update<NodeContent::remapped>();
    gather<Gather::deformation>();
  }

  void clear(bool opens) {
    const ProfilePhase<Device> phase(device_, "clear the grid");
    const int count = grid_.nodes();
    for_each(device_, std::max(count, 1),
             BeginStep<Real>{clock_.data(), nodes_.data(), forces_apart_ && opens ? forces_.data() : nullptr, count,
                             opens, shaking_.view()});
  }

  template <Scatter what>
  void scatter() {
    const ProfilePhase<Device> phase(device_, "points to grid");
    const auto run = [&]<class Laws>(const Materials<Real, Laws>& materials) {
      scatter_points(
          device_, points_.count(), grid_.groups(),
          ParticleToGrid<Real, Shape, what, Laws>{grid_.view(), points_.view(), materials, clock_.data(), nodes_.data(),
                                                  forces_.data(), loads_now_, affine_, dilatant_});
    };
    if constexpr (what == Scatter::momentum) {
      run(materials_);  // asks for no stress
    } else {
      with_laws_of(materials_, run);
    }
  }

  template <NodeContent content>
  void update() {
    constexpr bool first = content != NodeContent::remapped;
    const StepNodes<Real> at = step_nodes<content>();
    if (first) look_at_points(at);
    if (content == NodeContent::force && settings_.energy_budget) {
      update_nodes<content, content == NodeContent::force>();
      columns_.count_landing(at);
    } else {
      update_nodes<content, false>();
    }
    columns_.hold(at, walls_, first);
    if (surroundings_.contact().on()) meet_surfaces<content>();
    if (first) columns_.slow(at, surroundings_.bed(), this->column_density());
  }

  /// The method measures what the nodes' part of a step asks of the points, and sums up what they do; the update of the
  /// columns records it.
  void look_at_points(const StepNodes<Real>& at) {
    this->measure_columns();
    this->sum_motion(clock_.data());
    columns_.measure(at, surroundings_.bed());
  }

  /// Gravity in the precision of the nodes.
  Gravity<Real> gravity() const {
    const Vec3<double>& full = settings_.gravity.acceleration;
    return {{static_cast<Real>(full.x), static_cast<Real>(full.y), static_cast<Real>(full.z)}, settings_.gravity.ramp};
  }

  /// The nodes of a step, with the changes of their velocity where it keeps them.
  template <NodeContent content>
  StepNodes<Real> step_nodes() {
    return {.grid = grid_.view(),
            .active = grid_.active_list(),
            .blocks = grid_.active_blocks(),
            .nodes = {nodes_.data(), content == NodeContent::force ? forces_.data() : nullptr},
            .step = {clock_.data(), 0, {settings_.gravity.acceleration, settings_.gravity.ramp}}};
  }

  /// The method updates the nodes, in the kernel that does no more than is asked for.
  template <NodeContent content, bool counts>
  void update_nodes() {
    const ProfilePhase<Device> phase(device_, "grid");
    if constexpr (content == NodeContent::force) {
      if (solves_columns_) {
        solve_columns<counts>();
        return;
      }
    }
    for_each_column<block_columns>(
        device_, grid_.active_blocks(),
        UpdateColumns<Real, content, counts>{.grid = grid_.view(),
                                             .active = grid_.active_list(),
                                             .clock = clock_.data(),
                                             .nodes = nodes_.data(),
                                             .forces = forces_.data(),
                                             .gravity = gravity(),
                                             .walls = walls_,
                                             .friction = columns_.seen_by(surroundings_.bed()),
                                             .full_base = static_cast<Real>(this->full_base()),
                                             .damping = static_cast<Real>(settings_.damping),
                                             .columns = columns_.slowed(),
                                             .pressed = counts ? columns_.pressed() : nullptr,
                                             .density = this->column_density(),
                                             .maps = maps_.view(),
                                             .motion = motion_.sums()});
  }

  /// The method makes the nodes' part of a column-implicit step.
  template <bool counts>
  void solve_columns() {
    for_each(device_, grid_.active_blocks() * block_columns,
             SolveColumns<Real, counts>{.grid = grid_.view(),
                                        .active = grid_.active_list(),
                                        .clock = clock_.data(),
                                        .nodes = nodes_.data(),
                                        .forces = forces_.data(),
                                        .mobilities = mobilities_.data(),
                                        .gravity = gravity(),
                                        .walls = walls_,
                                        .friction = columns_.seen_by(surroundings_.bed()),
                                        .full_base = static_cast<Real>(this->full_base()),
                                        .damping = static_cast<Real>(settings_.damping),
                                        .kappa = static_cast<Real>(settings_.steps.kappa),
                                        .softer = softer_,
                                        .columns = columns_.slowed(),
                                        .pressed = counts ? columns_.pressed() : nullptr,
                                        .density = this->column_density(),
                                        .maps = maps_.view(),
                                        .motion = motion_.sums()});
  }

  /// The springs along the bed over those across it (T6b) [-]: the modulus of shear over that of uniaxial strain, of
  /// the material where that is most. Where columns meet more than their bed (walls across z, contact points), or stand
  /// not across it (Cartesian grids), springs are the same in all directions, which is an upper bound too.
  static Real softer(const Scene& scene, const IntegratorSettings& settings) {
    const auto across_z = [](const PlaneWall& wall) { return wall.axis == 2; };
    if (scene.grid.mapping == Mapping::cartesian || scene.contacts.size() > 0 ||
        std::ranges::any_of(settings.walls, across_z))
      return Real(1);
    Real most = 0;
    for (const Material<Real>& m : settings.materials.in<Real>().list) {
      const Real uniaxial = m.density * m.wave_speed * m.wave_speed;
      if (uniaxial > Real(0)) most = std::max(most, m.shear_modulus / uniaxial);
    }
    return most;
  }

  /// The method lets the nodes meet obstacles, and ground between the nodes (T12a). What is mapped back a second time
  /// is merely kept from running through them.
  template <NodeContent content>
  void meet_surfaces() {
    const ProfilePhase<Device> phase(device_, "contact");
    constexpr bool first = content != NodeContent::remapped;
    const PackedNodes<Real> nodes = step_nodes<content>().nodes;
    const auto run = [&](const auto& inertia) {
      surroundings_.impulses().run(surroundings_.contact(), grid_.view(), nodes, grid_.nodes(), inertia,
                                   {clock_.data(), 0, first, first});
    };
    if constexpr (content == NodeContent::force) {
      if (solves_columns_) {
        run(ColumnInertia<Real, Device>(device_, factors(), grid_.active_blocks()));
        return;
      }
    }
    run(NodeInertia<Device>(device_));
  }

  /// The columns once they have been solved for.
  SolvedColumns<Real> factors() {
    return {.grid = grid_.view(),
            .active = grid_.active_list(),
            .clock = clock_.data(),
            .mobilities = mobilities_.data(),
            .forces = forces_.data(),
            .kappa = static_cast<Real>(settings_.steps.kappa)};
  }

  template <Gather part>
  void gather() {
    const ProfilePhase<Device> phase(device_, "grid to points");
    const auto run = [&]<bool budget, class Laws>(const Materials<Real, Laws>& materials) {
      for_each(device_, points_.count(),
               GridToParticle<Real, Shape, part, budget, Laws>{grid_.view(), points_.view(), materials, clock_.data(),
                                                               nodes_.data(), keeps_ ? forces_.data() : nullptr,
                                                               grid_.home(), affine_, dilatant_, !solves_columns_});
    };
    if (settings_.energy_budget) {
      run.template operator()<true>(materials_);
    } else if constexpr (part == Gather::motion) {
      run.template operator()<false>(materials_);  // asks for no stress
    } else {
      with_laws_of(materials_, [&](const auto& materials) { run.template operator()<false>(materials); });
    }
  }

  void sort(int outflow_count) {
    const ProfilePhase<Device> phase(device_, "sort and storage");
    recording_.forget();
    this->fit(outflow_count);
    nodes_.resize(static_cast<std::size_t>(grid_.nodes()));
    if (forces_apart_) forces_.resize(static_cast<std::size_t>(grid_.nodes()));
    if (solves_columns_) mobilities_.resize(static_cast<std::size_t>(grid_.nodes()));
  }

  Recording<Device> recording_;  ///< of a step
  int expected_ = 32;            ///< steps between sorts
  bool affine_, musl_;
  bool keeps_;           ///< points keep some of the velocity that is finer than the grid
  bool solves_columns_;  ///< inertia is implicit by columns
  bool forces_apart_;
  Walls<Real> walls_;
  const Vec3<double>* loads_now_ = nullptr;
  Buffer<Vec4<Real>, Device> nodes_{device_}, forces_{device_};
  Buffer<Mobility<Real>, Device> mobilities_{device_};  ///< of the nodes, where columns are solved
  Real softer_;                                         ///< see softer()
  ColumnContact<Real, Device> columns_;
};

/// The definition for the files in instances/; see make_explicit_solver.hpp.
template <class Real, class Shape>
std::unique_ptr<Solver> make_explicit_solver(const Scene& scene, const IntegratorSettings& settings,
                                             const AnyDevice& device, const SolverState& state) {
#if TALUS_FOR_GPU
  if (device.is_gpu())
    return std::make_unique<ExplicitSolverOf<Real, GpuDevice, Shape>>(device.gpu(), scene, settings, state);
#endif
  return std::make_unique<ExplicitSolverOf<Real, CpuDevice, Shape>>(device.cpu(), scene, settings, state);
}

}  // namespace talus::solver
