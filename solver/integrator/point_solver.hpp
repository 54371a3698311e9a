// What every integrator has: the points, the grid, the clock and the maps, and how they are read.
#pragma once

#include "solver/boundary/contact_impulses.hpp"
#include "solver/grid/sparse_grid.hpp"
#include "solver/integrator/point_sums.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// The bed's friction and, where it changes from place to place, its numbers beside the grid.
template <class Number, class Device>
class BedOn {
 public:
  BedOn(const Device& device, const BaseFriction<double>& friction, const std::vector<Bed<double>>& columns)
      : columns_(device) {
    friction_.law = friction.law;
    friction_.uniform = friction.uniform.as<Number>();
    if (columns.empty()) return;
    std::vector<Bed<Number>> beds;
    for (const Bed<double>& bed : columns) beds.push_back(bed.as<Number>());
    columns_.upload(beds);
    friction_.columns = columns_.data();
  }
  /// The friction as kernels see it.
  BaseFriction<Number> view() const { return friction_; }
  /// The size of the numbers beside the grid [bytes].
  std::size_t bytes() const { return columns_.bytes(); }

 private:
  BaseFriction<Number> friction_;
  Buffer<Bed<Number>, Device> columns_;
};

/// The parts that every integrator has, with `Real` the precision of the points and `Shape` its shape functions.
template <class Real, class Device, class Shape>
class PointSolver : public Solver {
 public:
  PointSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings, const SolverState& state,
              ParticleNeeds needs, int drift)
      : device_(device),
        settings_(settings),
        materials_(settings.materials.in<Real>()),
        dilatant_(needs.plastic_volume),
        points_(device, needs),
        grid_(device, scene.grid, drift, settings.deterministic, Shape::width == 2),
        bed_(device, settings.bed, scene.bed),
        contact_(device, scene.contacts, bed_.view(), scene.grid, state.contacts, settings.deterministic),
        impulses_(device),
        frame_{{scene.map.x(0), scene.map.y(0), grid_.ground().datum},
               {scene.grid.spacing, scene.grid.spacing, scene.grid.layer_height}},
        load_volumes_(scene.load_volumes) {
    points_.upload(state.points);
    clock_.upload({state.clock});
    for_each_running_map([](const RunningMap&, auto& buffer, const auto& values) { buffer.upload(values); }, maps_,
                         state.maps);
  }

  ~PointSolver() override { drop_sort_space(device_); }
  PointSolver(const PointSolver&) = delete;
  PointSolver& operator=(const PointSolver&) = delete;

  /// The method sets the time not to step over [s]; see Solver for this and the next members.
  void set_next_event(double time) override {
    Clock clock = read_clock();
    clock.next_event = time;
    clock_.upload({clock});
  }

  /// The clock of the end of the last step; waits for the device.
  Clock clock() const override { return read_clock(); }

  /// All that a checkpoint keeps; waits for the device.
  SolverState state() const override {
    SolverState all{.points = points_.download(), .clock = read_clock(), .maps = {}, .contacts = contact_.state()};
    for_each_running_map([](const RunningMap&, auto& values, const auto& buffer) { values = buffer.download(); },
                         all.maps, maps_);
    return all;
  }

  /// The points as frames show them; waits for the device.
  ParticleState shown() const override { return points_.download(Kept::in_frames); }

  /// The sums over the points; waits for the device.
  Energies energies() override {
    const ProfilePhase<Device> phase(device_, "records and frames");
    constexpr int rows = MeasureEnergies<Real, Shape>::rows;
    totals_.resize(rows);
    sum_each<rows>(device_, points_.count(), sums_,
                   MeasureEnergies<Real, Shape>{grid_.view(), points_.view(), materials_,
                                                settings_.gravity.acceleration, dilatant_},
                   KeepTotals<rows>{totals_.data()});
    const std::vector<double> total = totals_.download();
    return {total[0], total[1], total[2], total[3], {total[4], total[5], total[6]}};
  }

  /// The vertical thickness, h of (T25), [rows * columns] [m]; waits for the device.
  std::vector<double> thickness() override {
    const ProfilePhase<Device> phase(device_, "records and frames");
    const GridShape& shape = grid_.shape();
    thickness_.resize(static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows));
    thickness_.fill_zero();
    for_each_grouped(device_, points_.count(), grid_.groups(),
                     ScatterThickness<Real, Shape>{points_.view(), shape.columns, thickness_.data()});
    std::vector<double> result = thickness_.download();
    for (double& value : result) value /= shape.spacing * shape.spacing;
    return result;
  }

  /// The impulse that every obstacle was given so far, along x, y and z [N s].
  std::vector<Vec3<double>> obstacle_impulses() const override { return contact_.obstacle_impulses(); }
  /// The terrain as kernels use it.
  const GroundTables& ground() const override { return grid_.ground(); }
  /// The number of points in the domain.
  int particle_count() const override { return points_.count(); }
  /// The memory taken by points, grid, maps and what else there is [bytes].
  MemoryShares memory() const override {
    std::size_t records = sums_.bytes() + column_volumes_.bytes() + thickness_.bytes();
    for_each_running_map([&](const RunningMap&, const auto& buffer) { records += buffer.bytes(); }, maps_);
    MemoryShares shares{
        {"points", points_.bytes()}, {"grid", grid_.bytes() + bed_.bytes()}, {"maps and records", records}};
    if (const std::size_t sorting = sort_space_bytes(device_); sorting > 0) shares.emplace_back("sorting", sorting);
    if (contact_.on()) shares.emplace_back("contact points", contact_.bytes() + impulses_.bytes());
    return shares;
  }

 protected:
  /// The method measures the volumes over the columns for the maps, where densities differ and mass does not give the
  /// thickness.
  void measure_columns() {
    if (!settings_.materials.densities_differ) return;
    column_volumes_.resize(static_cast<std::size_t>(grid_.shape().columns) *
                           static_cast<std::size_t>(grid_.shape().rows));
    column_volumes_.fill_zero();
    for_each_grouped(device_, points_.count(), grid_.groups(),
                     ScatterThickness<Real, Shape>{points_.view(), grid_.shape().columns, column_volumes_.data()});
  }
  const double* column_volumes() const { return column_volumes_.data(); }

  /// The method sorts the points and fits the grid to them; the `outflow_count` last ones are dropped.
  void fit(int outflow_count) {
    grid_.fit(points_, outflow_count);
    contact_.fit(grid_);
  }
  /// The mass of a full layer over a square metre [kg/m2].
  double layer_mass() const { return static_cast<double>(materials_.list[0].density) * frame_.cell[2]; }

  /// The mass of a base node under a full layer [kg].
  double full_base() const {
    return Shape::edge_share * static_cast<double>(materials_.list[0].density) * frame_.cell[0] * frame_.cell[1] *
           frame_.cell[2];
  }
  Clock read_clock() const { return clock_.download().front(); }
  MapView maps() {
    MapView view;
    for_each_running_map([](const RunningMap&, double*& values, auto& buffer) { values = buffer.data(); }, view, maps_);
    view.threshold = settings_.map_threshold;
    return view;
  }

  /// The walls that are there at a time, as kernels see them; the grid meets them as edges from now on.
  template <class Number>
  Walls<Number> set_walls(double time) {
    const Walls<Number> walls = walls_at<Number>(settings_.walls, time, frame_);
    grid_.set_walls(wall_nodes(walls));
    return walls;
  }

  /// The method uploads the force per volume of every load at a time [N/m3]; null when there are none.
  const Vec3<double>* upload_loads(double time) {
    if (load_volumes_.empty()) return nullptr;
    loads_.upload(load_densities(settings_.loads, load_volumes_, time));
    return loads_.data();
  }

  Device device_;
  IntegratorSettings settings_;
  Materials<Real> materials_;
  bool dilatant_;
  Particles<Real, Device> points_;
  SparseGrid<Real, Device> grid_;
  BedOn<Real, Device> bed_;
  SurfaceContact<Real, Device, Shape> contact_;
  ContactImpulses<Real, Device, Shape> impulses_;
  WallFrame frame_;
  std::vector<double> load_volumes_;  ///< [m3]
  Buffer<Vec3<double>, Device> loads_{device_};
  Buffer<Clock, Device> clock_{device_};
  Buffer<double, Device> column_volumes_{device_};
  RunningMaps<Buffer<double, Device>> maps_ = make_running_maps<Buffer<double, Device>>(device_);
  Buffer<double, Device> totals_{device_}, thickness_{device_};
  SumSpace<Device> sums_{device_};
};

}  // namespace talus::solver
