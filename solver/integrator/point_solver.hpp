// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator has: the points, the grid, the clock and the maps, and how they are read.
#pragma once

#include <memory>

#include "common/run/mobility.hpp"
#include "solver/grid/sparse_grid.hpp"
#include "solver/integrator/device_state.hpp"
#include "solver/integrator/particle_measures.hpp"
#include "solver/parallel/recording.hpp"
#include "solver/water/water_columns.hpp"

namespace talus::solver {

/// The parts that every integrator has, with `Real` the precision of the points and `Shape` its shape functions.
template <class Real, class Device, class Shape>
class PointSolver : public Solver {
 public:
  PointSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings, const SolverState& state,
              ParticleNeeds needs, const Drift& drift)
      : device_(device),
        settings_(settings),
        materials_(settings.materials.in<Real>()),
        dilatant_(needs.plastic_volume),
        points_(device, needs),
        grid_(device, scene.grid, drift, settings.deterministic, Shape::width == 2),
        water_(device, settings.water,
               {scene.water_table, settings.water_ratio, static_cast<double>(materials_.list[0].density),
                settings.fastest_wave * settings.fastest_wave * static_cast<double>(materials_.list[0].density)},
               needs.accelerations),
        maps_(device, state.maps, settings.map_threshold.value_or(covering_thickness({}))),
        surroundings_(device, scene, settings, state.contacts, grid_.ground().datum, maps_.view().grains_share),
        clock_(device, clock_of(state, settings)),
        loads_(device, settings.loads, scene.load_volumes),
        shaking_(device, scene.shaking),
        measures_(device, scene.grid),
        measuring_(device),
        motion_(device) {
    points_.upload(state.all_points());
  }

  ~PointSolver() override { drop_sort_space(device_); }
  PointSolver(const PointSolver&) = delete;
  PointSolver& operator=(const PointSolver&) = delete;

  /// The method sets the time not to step over [s]; see Solver for this and the next members.
  void set_next_event(double time) override {
    Clock clock = clock_.read();
    clock.next_event = time;
    clock_.write(clock);
  }

  Clock clock() const override { return clock_.read(); }

  SolverState state() const override {
    return {.points = points_.download(),
            .clock = clock_.read(),
            .maps = maps_.download(),
            .contacts = surroundings_.contact().state()};
  }

  SolverState end_state() const override {
    return {.points = points_.download(points_.needs().boxes ? Kept::in_checkpoint : Kept::to_the_end),
            .clock = clock_.read(),
            .maps = maps_.download(),
            .contacts = {}};
  }

  void show(ParticleState& to) const override { points_.download(Kept::in_frames, to); }

  Energies energies() override {
    if (!measured_) measuring_.repeat(1, [&] { start_measures(); });
    measured_ = Device::is_gpu;
    return measures_.energies();
  }

  Packing packing() override {
    if (!measured_) measures_.start_packing(points_.view(), grid_);
    return measures_.packing();
  }

  std::vector<double> thickness() override { return measures_.thickness(points_.view(), grid_.groups()); }

  std::vector<double> grains_share() const override { return maps_.grains_share(); }

  std::vector<Vec3<double>> obstacle_impulses() const override { return surroundings_.contact().obstacle_impulses(); }
  const TerrainTables& ground() const override { return grid_.ground(); }
  int particle_count() const override { return points_.count(); }
  /// The memory taken by points, grid, maps and what else there is [bytes].
  MemoryShares memory() const override {
    MemoryShares shares{{"points", points_.bytes()},
                        {"grid", grid_.bytes() + surroundings_.bed_bytes()},
                        {"maps and records", maps_.bytes() + measures_.bytes() + motion_.bytes() + shaking_.bytes()}};
    if (const std::size_t sorting = sort_space_bytes(device_); sorting > 0) shares.emplace_back("sorting", sorting);
    if (water_.on()) shares.emplace_back("water", water_.bytes());
    if (surroundings_.contact().on()) shares.emplace_back("contact points", surroundings_.contact_bytes());
    return shares;
  }

 protected:
  /// Measures the volumes over the columns for the maps, where densities differ and mass does not give the thickness.
  void measure_columns() {
    if (settings_.materials.densities_differ) measures_.measure_columns(points_.view(), grid_.groups());
  }

  /// The still water of the scene, its level over the datum of the ground.
  Submersion<Real> submersion() const {
    Submersion<double> water = settings_.submersion;
    water.level -= grid_.ground().datum;
    return water.as<Real>();
  }
  /// The gravity of the scene.
  Gravity<Real> gravity() const { return {narrow<Real>(settings_.gravity_vector()), settings_.gravity_ramp}; }
  /// The method lets water flow between the grains where the clock says so. For the others see WaterColumns::flow().
  void flow_water(const Gravity<Real>& gravity, const Vec3<double>* loads, const Vec4<Real>* nodes) {
    water_.flow(points_.view(), materials_, grid_, {clock_.data(), gravity, loads, nodes, submersion(), maps_.view()});
  }

  /// The method lets water flow for no time as a run begins, under all of its gravity: the first time tells the points
  /// what they bear, the second one the bed.
  void meet_water() {
    const Clock clock = clock_.read();
    if (!water_.on() || clock.step > 0) return;
    set_walls<Real>(clock.time);
    const Vec3<double>* const loads = loads_.upload(clock.time, clock.time);
    for (int time = 0; time < 2; ++time) flow_at_once(loads);
  }
  /// The method lets water flow outside a batch of steps, for the time since it flowed last and under all of gravity:
  /// statics that load the mass in one step would begin without any.
  void flow_at_once(const Vec3<double>* loads) {
    Clock clock = clock_.read();
    clock.flow_water(clock.time, 0);
    clock_.write(clock);
    clock_.hand_over();
    flow_water({.full = gravity().full}, loads, nullptr);
    clock = clock_.read();
    clock.water.is_due = 0;
    clock_.write(clock);
  }

  /// The density of what lies over each column, as it was measured last.
  ColumnDensity<Real> column_density() const { return {materials_.list[0].density, measures_.column_volumes()}; }
  /// The scatter that sums up the motion of the points over the columns, whenever the clock says so, or always where
  /// that is null; they must not have gone further since they were sorted than a step may begin with.
  auto sum_of_motion(const Clock* clock) { return motion_.sum(points_.view(), materials_, grid_.view(), clock); }
  /// The method records the maps of speed and pressure from the points as they are.
  void record_motion() {
    measure_columns();
    const ProfilePhase<Device> phase(device_, "maps");
    scatter_points(device_, points_.count(), grid_.groups(), sum_of_motion(nullptr));
    motion_.record(grid_, column_density(), maps_.view());
  }

  /// Starts to measure what a record asks for: the energies, and where that is no work of the host's the packing too.
  void start_measures() {
    measures_.start_energies(points_.count(),
                             {grid_.view(), points_.view(), materials_, settings_.gravity_vector(), dilatant_});
    if constexpr (Device::is_gpu) measures_.start_packing(points_.view(), grid_);
  }

  /// The method sorts the points and fits the grid to them; the `outflow_count` last ones are dropped.
  void fit(int outflow_count) {
    measuring_.forget();
    measured_ = false;
    grid_.fit(points_, outflow_count);
    water_.resize(static_cast<std::size_t>(grid_.nodes()));
    surroundings_.contact().fit(grid_);
  }
  /// The mass of a full layer over a square metre [kg/m2].
  double layer_mass() const { return static_cast<double>(materials_.list[0].density) * grid_.shape().layer_height; }

  /// The mass of a base node under a full layer [kg].
  double full_base() const {
    const GridShape& shape = grid_.shape();
    return Shape::edge_share * static_cast<double>(materials_.list[0].density) * shape.spacing * shape.spacing *
           shape.layer_height;
  }
  /// The method takes account of points that have come with this `rate` [1/s].
  static void note_points(Clock& clock, double rate) {
    clock.water.add_points(clock.step);
    atomic_max_positive(&clock.control.rate_bits, static_cast<float>(rate));
    clock.alarms.halt = clock.alarms.request = running;
  }

  static Clock clock_of(const SolverState& state, const IntegratorSettings& settings) {
    Clock clock = state.clock;
    clock.subgrid.decay_time = settings.decay_time;
    return clock;
  }

  /// The walls that are there at a time, as kernels see them; the grid meets them as edges from now on.
  template <class Number>
  Walls<Number> set_walls(double time) {
    const Walls<Number> walls = surroundings_.template walls<Number>(time);
    grid_.set_walls(wall_nodes(walls));
    return walls;
  }

  Device device_;
  IntegratorSettings settings_;
  Materials<Real> materials_;
  bool dilatant_;  ///< plastic flow changes the volume
  Particles<Real, Device> points_;
  SparseGrid<Real, Device> grid_;
  WaterColumns<Real, Device, Shape> water_;
  DeviceMaps<Device> maps_;
  Surroundings<Real, Device, Shape> surroundings_;
  DeviceClock<Device> clock_;
  DeviceLoads<Device> loads_;
  DeviceShaking<Device> shaking_;
  ParticleMeasures<Real, Device, Shape> measures_;
  Recording<Device> measuring_;  ///< of a record's measures
  bool measured_ = false;        ///< energies and packing are known for the points as they are
  MotionMaps<Real, Device, Shape> motion_;
};

/// A solver of a class template on the device that is asked for.
template <template <class, class, class> class SolverOn, class Real, class Shape, class... Arguments>
std::unique_ptr<Solver> make_solver_on(const AnyDevice& device, const Arguments&... arguments) {
#if TALUS_FOR_GPU
  if (device.is_gpu()) return std::make_unique<SolverOn<Real, GpuDevice, Shape>>(device.gpu(), arguments...);
#endif
  return std::make_unique<SolverOn<Real, CpuDevice, Shape>>(device.cpu(), arguments...);
}

}  // namespace talus::solver
