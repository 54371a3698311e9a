// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit steps: Newton on the unbalanced force of the end of the step, shape functions held at its start. Included by
// the files that instantiate it.
#pragma once

#include <algorithm>

#include "solver/implicit/implicit_step.hpp"
#include "solver/integrator/make_solvers.hpp"
#include "solver/integrator/point_solver.hpp"

namespace talus::solver {

/// The integrator of implicit steps, by Newmark's scheme or as a sequence of equilibria: particles are sorted before
/// every step, a step that does not converge is cut.
template <class Real, class Device, class Shape>
class ImplicitSolver final : public PointSolver<Real, Device, Shape> {
  using Base = PointSolver<Real, Device, Shape>;
  using Base::clock_, Base::device_, Base::dilatant_, Base::grid_, Base::loads_, Base::maps_, Base::materials_,
      Base::measures_, Base::points_, Base::settings_, Base::shaking_, Base::surroundings_;

 public:
  ImplicitSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings,
                 const ImplicitControls& controls, const SolverState& state)
      : Base(device, scene, settings, state, needs(settings), {.columns = 0, .layers = 0}),
        controls_(with_materials(controls, scene.grid.layer_height)),
        step_(parts(), DeviceBed<double, Device>(device, settings.bed, scene.bed, maps_.view().grains_share)),
        length_(controls.step, controls.newton_iterations) {
    this->fit(0);
    this->meet_water();
  }

  /// The method makes one step, or a part of one where it had to be cut; see Solver::advance(). It throws
  /// NumericalError where the smallest step does not converge. Where the controls give up, the state stays that of the
  /// step's start, and the report counts no iteration.
  BatchReport advance() override {
    this->measured_ = false;
    Clock clock = clock_.read();
    clock.alarms.halt = clock.alarms.request = running;
    clock.control.fastest_bits = std::max(clock.control.fastest_bits, clock.control.speed_bits);
    clock.control.rate_bits = clock.control.speed_bits = 0;
    if (loads_.jump_at(clock.time)) clock.accelerated = 0;
    fit_grid(clock.time);
    record_points();
    let_water_flow(clock);
    BatchReport report;
    const double step = solve_step(clock, report.stats);
    if (!(step > 0)) {
      report.sorted = report.can_be_saved = true;
      report.clock = clock;
      report.stats = {};
      return report;
    }
    clock.accelerated = 1;
    clock.step_size = step;
    clock.time = clock.next_event - clock.time <= step * (1 + 1e-12) ? clock.next_event : clock.time + step;
    if (shaking_.host().acts()) clock.shake(shaking_.host().view().velocity_at(clock.time));
    ++clock.step;
    clock_.write(clock);
    accept(clock, step);
    close(report, step);
    return report;
  }

  /// The method adds points; see Solver::add(). Every step sorts before it begins.
  void add(const ParticleState& points, double rate) override {
    points_.append(points);
    this->fit(0);
    Clock clock = clock_.read();
    this->note_points(clock, rate);
    clock_.write(clock);
  }

  MemoryShares memory() const override {
    MemoryShares shares = Base::memory();
    step_.list_memory([&](const char* name, std::size_t bytes) {
      if (bytes > 0) shares.emplace_back(name, bytes);
    });
    return shares;
  }

 private:
  static ParticleNeeds needs(const IntegratorSettings& settings) {
    ParticleNeeds n = settings.needs;
    n.accelerations = true;
    return n;
  }

  /// The controls; the materials learn from them how round the cone's tip is (T15b).
  const ImplicitControls& with_materials(const ImplicitControls& c, double layer_height) {
    constexpr double apex = 0.1;  // in weights of a cell
    const double g = settings_.gravity_size();
    for (Material<Real>& m : materials_.list)
      prepare_for_newton(m, static_cast<Real>(apex * static_cast<double>(m.density) * g * layer_height));
    return c;
  }
  StepParts<Real, Device, Shape> parts() {
    return {.device = device_,
            .settings = settings_,
            .controls = controls_,
            .points = points_,
            .grid = grid_,
            .materials = materials_,
            .dilatant = dilatant_,
            .surfaces = surroundings_.contact(),
            .impulses = surroundings_.impulses(),
            .sums = measures_.sums(),
            .cell = {.spacing = grid_.shape().spacing,
                     .layer_height = grid_.shape().layer_height,
                     .layer_mass = this->layer_mass(),
                     .full_base = this->full_base()}};
  }

  void fit_grid(double time) {
    const ProfilePhase<Device> phase(device_, "sort and storage");
    this->fit(0);
    step_.group(this->template set_walls<double>(time));
  }

  /// The time to what a step may not pass over: the next event, or a sample of the accelerogram, between which the
  /// ground's acceleration is linear [s]. Samples that follow at once, as the edges of a pulse do, ask for no step.
  double remaining(const Clock& clock) const {
    constexpr double least = 0.01;  // of the longest step
    return std::min(clock.next_event, shaking_.host().next_sample(clock.time, least * controls_.step)) - clock.time;
  }
  /// The acceleration of the ground, its mean over a step (T42) [m/s2].
  Vec3<double> shaking_of(Clock clock, double step) const {
    if (!shaking_.host().acts()) return {};
    clock.step_size = step;
    clock.shake(shaking_.host().view().velocity_at(clock.time + step));
    return clock.ground_acceleration();
  }

  /// Solves for the end of the next step; returns its length [s], 0: given up. Throws NumericalError: no halving helps.
  double solve_step(const Clock& clock, StepStats& stats) {
    const bool knows = clock.accelerated != 0, midway = clock.step > 0;
    double step = length_.next(remaining(clock));
    for (int cut = 0;; ++cut) {
      // After explicit steps light nodes are far out of balance, and after the jump of a force all are: backward Euler
      // asks for no acceleration to begin with.
      step_.begin({.start = clock.time,
                   .step = step,
                   .accelerates = !knows && !midway,
                   .backward_euler = !knows && midway,
                   .loads = loads_.upload(clock.time, clock.time + step),
                   .shaking = shaking_of(clock, step),
                   .shaking_before = knows ? clock.ground_acceleration() : shaking_of(clock, step)});
      const NewtonReport found = step_.solve();
      stats.newton += found.iterations;
      stats.linear += found.linear_iterations;
      stats.cuts = cut;
      stats.residual = found.residual;
      stats.linear_residual = found.linear_residual;
      stats.indefinite = stats.indefinite || found.indefinite;
      if (found.converged) {
        length_.accept(step, found.iterations, found.motion);
        return step;
      }
      if (controls_.gives_up()) return 0;
      if (cut >= controls_.step_cuts) refuse_step(clock, step, stats, controls_.dynamic);
      step = length_.refuse(step, found.motion);
    }
  }

  /// The method lets water flow as long as the step before has taken.
  void let_water_flow(Clock& clock) {
    if (!this->water_.on()) return;
    clock_.write(clock);
    this->flow_at_once(loads_.upload(clock.time, clock.time));
    clock = clock_.read();
  }

  void accept(const Clock& clock, double step) {
    const ProfilePhase<Device> phase(device_, "grid to points");
    clock_.hand_over();
    step_.accept(clock_.data(), clock.share_kept(step));
    this->measure_columns();
    step_.record_maps(maps_.view(), clock.time, this->column_density());
  }

  /// The method records speed and pressure of the points as they are, sorted.
  void record_points() {
    if (controls_.dynamic) this->record_motion();
  }

  /// The method reports what the step ended with, and drops particles that left the domain.
  void close(BatchReport& report, double step) {
    Clock clock = clock_.read();
    report.outflow_count = clock.outflow.count;
    report.outflow_volume = clock.outflow.volume;
    clock.control.fastest_bits = std::max(clock.control.fastest_bits, clock.control.speed_bits);
    report.stats.over_cfl = step * static_cast<double>(positive_from_bits(clock.control.rate_bits));
    if (clock.alarms.request == failed) clock.alarms.halt = failed;
    if (clock.alarms.halt != failed && clock.time >= clock.next_event) clock.alarms.halt = at_event;
    // What is looked at between steps, by cell and column, finds the points sorted.
    if (report.outflow_count > 0 || clock.alarms.halt == at_event) this->fit(report.outflow_count);
    if (clock.alarms.halt == at_event) record_points();
    report.sorted = report.can_be_saved = true;
    clock.outflow.count = 0;  // reported
    clock.outflow.volume = 0;
    report.clock = clock;
    clock.alarms.halt = clock.alarms.request = running;
    clock_.write(clock);
  }

  ImplicitControls controls_;
  ImplicitStep<Real, Device, Shape> step_;
  StepLength length_;
};

template <class Real, class Shape>
std::unique_ptr<Solver> ImplicitSolvers<Real, Shape>::make(const Scene& scene, const IntegratorSettings& settings,
                                                           const ImplicitControls& controls, const AnyDevice& device,
                                                           const SolverState& state) {
  return make_solver_on<ImplicitSolver, Real, Shape>(device, scene, settings, controls, state);
}

}  // namespace talus::solver
