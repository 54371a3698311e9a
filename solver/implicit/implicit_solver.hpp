// Implicit steps: Newton on the unbalanced force of the end of the step, shape functions held at its start. Included by
// the files that instantiate it.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "solver/implicit/accept_step.hpp"
#include "solver/implicit/contact_forces.hpp"
#include "solver/implicit/controls.hpp"
#include "solver/implicit/implicit_nodes.hpp"
#include "solver/implicit/newton_control.hpp"
#include "solver/implicit/scatter_inertia.hpp"
#include "solver/integrator/point_solver.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/step_failure.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"
#include "solver/linear/krylov/bicgstab.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"
#include "solver/linear/operator/tangent_operator.hpp"
#include "solver/linear/preconditioner/preconditioner.hpp"

namespace talus::solver {

/// Statics on few points per cell leaves modes of the splines that no point's gradient sees: the share of the diagonal
/// that holds them in a factorisation. The change it makes to a step is undone by the next Newton iteration.
inline constexpr double static_shift = 1e-12;

/// One thread: one column. Maps of the end of a step.
template <class Real>
struct RecordColumns {
  GridView<Real> grid;
  const int* active;
  const double* mass;
  const Vec3<double>* velocity;  // null in statics
  double density;                // where all points have the same [kg/m3]
  const double* volumes;         // of the matter over each column, where they differ [m3]; else null
  double time;
  MapView maps;
  TALUS_HD void operator()(int c) const {
    const int block = active[c / block_columns], inside = c % block_columns;
    const int i = (block % grid.block_columns_x) * block_side + (inside & 3);
    const int j = (block / grid.block_columns_x) * block_side + (inside >> 2);
    if (i >= grid.columns || j >= grid.rows) return;
    const BlockSlot slot = grid.slots[block];
    double total = 0;
    Vec3<double> momentum{};
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      const int n = GridView<Real>::node(slot, i, j, k);
      total += mass[n];
      if (velocity && mass[n] > 0) momentum += velocity[n] * mass[n];
    }
    const double spacing = static_cast<double>(grid.spacing);
    const int column = grid.column(i, j);
    const double mean = volumes && volumes[column] > 0 ? total / volumes[column] : density;
    if (total > 0) record_column(maps, column, total, length(momentum), mean, spacing, time);
  }
};

template <class Real, class Device, class Shape>
class ImplicitSolverOf final : public PointSolver<Real, Device, Shape> {
  using Base = PointSolver<Real, Device, Shape>;
  using Base::clock_, Base::contact_, Base::dilatant_, Base::impulses_, Base::grid_, Base::materials_, Base::points_,
      Base::read_clock, Base::sums_;

 public:
  ImplicitSolverOf(const Scene& scene, const IntegratorSettings& settings, const ImplicitControls& controls,
                   const SolverState& state)
      : Base(scene, settings, state, fields(settings), 0),  // sorted before every step
        controls_(controls),
        affine_(controls.affine),
        dynamic_(controls.dynamic),
        node_bed_(settings.bed, scene.bed),
        step_(controls.step),
        first_(state.clock.accelerated == 0),
        midway_(state.clock.step > 0),
        single_(std::is_same_v<Real, double> && controls.newton.iterations > 1 &&
                controls.linear.solver != LinearSolver::cholesky),
        operator_(controls.linear.form, single_),
        preconditioner_(controls.linear.preconditioner) {
    balance_.upload({Balance{}});
    this->fit(0);
    const double g = std::hypot(controls.gravity.x, controls.gravity.y, controls.gravity.z);
    for (Material<Real>& m : materials_.list) {
      m.exact_tangent = controls.tangent == Tangent::exact;
      m.apex = static_cast<Real>(controls.apex * static_cast<double>(m.density) * g * scene.grid.layer_height);
    }
  }

  BatchReport advance() override {
    Clock clock = read_clock();
    clock.halt = clock.request = running;
    clock.outflow_count = 0;
    clock.outflow_volume = 0;
    rate_ = static_cast<double>(positive_from_bits(clock.rate_bits));
    clock.rate_bits = clock.speed_bits = 0;
    fit_grid(clock.time);
    BatchReport report;
    double step = next_step(clock);
    for (int cut = 0;; ++cut) {
      report.stats = {};
      report.stats.cuts = cut;
      if (solve_step(clock.time, step, report.stats)) break;
      if (cut >= controls_.step_cuts) refuse_step(clock, step, report.stats, dynamic_);
      step *= 0.5;
      step_ = step;
    }
    first_ = false;
    clock.accelerated = 1;
    clock.step_size = step;
    clock.time = clock.next_event - clock.time <= step * (1 + 1e-12) ? clock.next_event : clock.time + step;
    ++clock.step;
    clock_.upload({clock});
    accept(clock, step);
    if (report.stats.cuts == 0) step_ = std::min(step_ * 1.5, controls_.step);
    clock = read_clock();
    report.outflow_count = clock.outflow_count;
    report.outflow_volume = clock.outflow_volume;
    report.stats.over_cfl = step * static_cast<double>(positive_from_bits(clock.rate_bits));
    if (clock.request == failed) clock.halt = failed;
    if (clock.halt != failed && clock.time >= clock.next_event) clock.halt = at_event;
    if (report.outflow_count > 0) this->fit(report.outflow_count);
    report.sorted = true;
    report.clock = clock;
    clock.halt = clock.request = running;
    clock_.upload({clock});
    return report;
  }

  MemoryShares memory() const override {
    const auto sum = [](const auto&... buffers) { return (buffers.bytes() + ... + std::size_t{0}); };
    MemoryShares shares = Base::memory();
    shares.emplace_back("nodes", sum(mass_, velocity_, arrival_, acceleration_, external_, internal_, u_, residual_,
                                     velocity_end_, acceleration_end_, change_, saved_u_, freed_, touch_));
    shares.emplace_back("bed and walls", sum(node_bed_, normal_, wall_freed_, contact_friction_, traction_,
                                             friction_limit_, along_, wavers_, stiffness_));
    if (contact_.on())
      shares.emplace_back("contact forces", sum(springs_, grips_, tractions_, limits_, contact_stiffness_));
    shares.emplace_back("tangents", sum(tangents_, single_tangents_, means_));
    shares.emplace_back("elements", sum(elements_));
    shares.emplace_back("operator", sum(operator_));
    shares.emplace_back("preconditioner", sum(preconditioner_));
    shares.emplace_back("Krylov vectors", sum(cg_, bicgstab_));
    shares.emplace_back("factor and its matrix",
                        cholesky_.bytes() + static_cast<std::size_t>(cholesky_.factor().factor_bytes()));
    std::erase_if(shares, [](const auto& share) { return share.second == 0; });
    return shares;
  }

 private:
  static ParticleFields fields(const IntegratorSettings& settings) {
    ParticleFields f = settings.fields;
    f.acceleration = true;
    return f;
  }

  /// The step to try: the stated one, grown back after cuts, never over an event.
  double next_step(const Clock& clock) const {
    const double remaining = clock.next_event - clock.time;
    if (step_ >= remaining * (1 - 1e-9)) return remaining;
    return remaining < 2 * step_ * (1 - 1e-9) ? 0.5 * remaining : step_;
  }

  NodeArrays nodes() {
    NodeArrays n;
    n.mass = mass_.data();
    n.velocity = velocity_.data();
    n.arrival = dynamic_ ? arrival_.data() : nullptr;
    n.acceleration = dynamic_ ? acceleration_.data() : nullptr;
    n.external = external_.data();
    n.internal = internal_.data();
    n.u = u_.data();
    n.residual = residual_.data();
    n.freed = freed_.data();
    n.touch = touch_.data();
    return n;
  }
  Constraints held() {
    return {wall_freed_.data(),
            normal_.data(),
            contact_friction_.data(),
            traction_.data(),
            friction_limit_.data(),
            along_.data(),
            wavers_.data(),
            corner_.slip(),
            corner_.nudge(),
            controls_.tangent == Tangent::exact,
            controls_.newton.iterations == 1,
            &balance_.data()->pull};
  }

  void size_nodes() {
    count_ = this->grid_.nodes();
    const auto n = static_cast<std::size_t>(count_);
    mass_.resize(n);
    mass_.fill_zero();
    for (auto* v : {&velocity_, &arrival_, &acceleration_, &external_}) {
      v->resize(n);
      v->fill_zero();
    }
    for (auto* v : {&internal_, &u_, &residual_, &normal_, &velocity_end_, &acceleration_end_, &change_, &saved_u_}) {
      v->resize(n);
    }
    freed_.resize(n);
    wall_freed_.resize(n);
    contact_friction_.resize(n);
    if (node_bed_.view().has_traction()) traction_.resize(n);
    friction_limit_.resize(n);
    touch_.resize(n);
    along_.resize(n);
    wavers_.resize(n);
    const auto numbers =
        static_cast<std::size_t>(TangentStore<Real>::numbers) * static_cast<std::size_t>(points_.count());
    if (single_) {
      single_tangents_.resize(numbers);
    } else {
      tangents_.resize(numbers);
    }
  }

  void fit_grid(double time) {
    const ProfilePhase<Device> phase("sort and storage");
    this->fit(0);
    walls_ = this->template stand_walls<double>(time);
    group_elements();
  }

  /// Everything that does not change with the displacement.
  void prepare(double start, double step) {
    const ProfilePhase<Device> phase("points to grid");
    const double time = start + step;  // loads are those at the end of the step, walls those that stand at its start
    size_nodes();
    scheme_ = {dynamic_, controls_.alpha, controls_.beta, step};
    // After explicit steps, light nodes are far out of balance: backward Euler asks for no acceleration to begin with.
    if (first_ && midway_) scheme_ = {dynamic_, 0.5, 1, step};
    corner_.smooths = dynamic_;
    corner_.fall = fall(step);
    const Vec3<double>* loads = this->upload_loads(time);
    scatter_points(Device{}, points_.count(), this->grid_.groups(),
                   ScatterInertia<Real, Shape>{
                       {this->grid_.view(), points_.view()}, materials_, affine_, dynamic_, loads, nodes()});
    const double ramp = controls_.gravity_ramp > 0 ? std::min(1.0, time / controls_.gravity_ramp) : 1.0;
    const Vec3<double> g{controls_.gravity.x * ramp, controls_.gravity.y * ramp, controls_.gravity.z * ramp};
    const bool predict = dynamic_ && controls_.newton.iterations > 1;
    for_each(Device{}, this->grid_.active_blocks() * block_columns,
             PrepareNodes<Real>{this->grid_.view(), this->grid_.active_list(), nodes(), held(), walls_,
                                node_bed_.view(), this->full_base(), g, scheme_, predict});
    if (contact_.on()) prepare_surfaces(step, predict);
    if (dynamic_)
      sum_each<1>(Device{}, count_, sums_, SquareMomentum{nodes()}, KeepTotals<1>{&balance_.data()->momentum});
    if (!dynamic_) return;
    const bool accelerates = first_ && !midway_, damps = controls_.damping > 0;
    if (!accelerates && !damps) return;
    copy(u_, saved_u_);  // both are of the start of the step
    u_.fill_zero();
    measure_stress(false);
    if (accelerates) for_each(Device{}, count_, FirstAcceleration{nodes()});
    if (damps) for_each(Device{}, count_, AddDamping{nodes(), controls_.damping});
    copy(saved_u_, u_);
  }

  /// Friction of the contact points for this step, and what they take at once.
  void prepare_surfaces(double step, bool predict) {
    const auto n = static_cast<std::size_t>(contact_.count());
    springs_.resize(n);
    grips_.resize(n);
    tractions_.resize(n);
    limits_.resize(n);
    contact_stiffness_.resize(n);
    contact_stiffness_.fill_zero();
    contact_.each(MeasureGrip<Real, Shape>{this->grid_.view(), contact_.view(), nodes(), this->layer_mass(), dynamic_,
                                           contact_numbers()});
    if (!dynamic_) return;
    impulses_.run(contact_, this->grid_.view(), ArrivingNodes<Real>{nodes(), predict ? step : 0}, count_,
                  this->layer_mass(), {nullptr, step, true, false});
  }
  ContactNumbers contact_numbers() {
    const double wave = static_cast<double>(materials_.list[0].wave_speed);
    const double modulus = static_cast<double>(materials_.list[0].density) * wave * wave;  // of uniaxial strain
    return {
        springs_.data(),           grips_.data(),
        tractions_.data(),         limits_.data(),
        contact_stiffness_.data(), contact_stiffness * modulus / std::min(this->frame_.cell[0], this->frame_.cell[2])};
  }

  /// See FrictionCorner.
  double fall(double step) const {
    const double g = std::hypot(controls_.gravity.x, controls_.gravity.y, controls_.gravity.z);
    return dynamic_ ? 0.5 * std::max(g, 1e-3) * step * step : 1e-4 * this->frame_.cell[0];
  }

  TangentStore<Real> tangents() { return {tangents_.data(), points_.count(), single_tangents_.data()}; }

  void measure_stress(bool with_tangent, bool definite = false) {
    const ProfilePhase<Device> phase("stress and tangent");
    internal_.fill_zero();
    average(u_);
    using Stress = StressAt<Real, Shape>;
    scatter_points(
        Device{}, points_.count(), this->grid_.groups(),
        ScatterForces<Real, Shape, Stress>{{this->grid_.view(), points_.view()},
                                           Stress{materials_, dilatant_, definite, means(),
                                                  with_tangent ? tangents() : TangentStore<Real>{}, u_.data()},
                                           internal_.data()});
    if (springs().on()) apply_springs(elements_, springs(), u_, internal_);
    if (contact_.on())
      contact_.each(
          ScatterContacts<Real, Shape>{this->grid_.view(), contact_.view(), nodes(), contact_numbers(), with_tangent});
  }

  MeanDilationView<Real> means() const { return controls_.b_bar ? means_.view() : MeanDilationView<Real>{}; }

  /// B-bar: means over the elements for a displacement.
  void average(const NodeVector<Device>& u) {
    if (controls_.b_bar) means_.measure(elements_, this->grid_.view(), points_.view(), materials_, dilatant_, u.data());
  }

  /// On nodes with less than a tenth of a full one's mass, in statics.
  FillerSprings springs() const {
    if (dynamic_) return {};
    const double h = this->frame_.cell[0], hz = this->frame_.cell[2];
    const double full = static_cast<double>(materials_.list[0].density) * h * h * hz;
    return {mass_.data(), 0.1 * full,
            controls_.filler * 2 * static_cast<double>(materials_.list[0].shear_modulus) * std::min(h, hz)};
  }

  /// The unbalanced force for u_, with what `held` and the contacts' states say about it.
  Balance measure_residual(bool decide) {
    const ProfilePhase<Device> phase("residual and contact");
    if (decide) {
      if (contact_.on())
        contact_.each(RenewLimits<Real, Shape>{this->grid_.view(), contact_.view(), nodes(), contact_numbers()});
      const double each = controls_.newton.tolerance / std::sqrt(static_cast<double>(std::max(count_, 1)));
      sum_each<1>(Device{}, count_, sums_, SquareForces{nodes()},
                  FinishForces{balance_.data(), stopping_share(), each});
    }
    sum_each<3>(Device{}, count_, sums_,
                MeasureResidual{nodes(), held(), scheme_, decide, decide ? nullptr : change_.data()},
                FinishResidual{balance_.data()});
    const Balance balance = balance_.download().front();
    for_each(Device{}, 1, ForgetChanges{balance_.data()});
    return balance;
  }

  /// The same after the contacts' states have been decided on.
  Balance decide_contacts(bool& changed) {
    const Balance balance = measure_residual(true);
    changed = balance.changes > 0;
    if (!changed) return balance;
    measure_stress(true);  // a contact that closed or opened has moved its node
    return measure_residual(false);
  }

  /// See force_size.
  double stopping_share() const {
    constexpr double rounding = 1e-8;
    return dynamic_ ? rounding / (scheme_.alpha * scheme_.step) : 0;
  }

  /// Elements and neighbours of the points as they stand.
  void group_elements() {
    const ImplicitControls& o = controls_;
    const bool direct = o.linear.solver == LinearSolver::cholesky;
    const bool preconditioned =
        !direct && NodePreconditioner<Real, Device, Shape>::by_elements(o.linear.preconditioner);
    if (dynamic_ && !direct && !preconditioned && o.linear.form == Operator::points && !o.b_bar)
      return;  // nothing goes by elements
    elements_.build(this->grid_.view(), points_.view());
    if (o.b_bar) means_.begin_step(elements_, points_.count());
    if (direct) {
      cholesky_.begin_step(elements_);
    } else {
      operator_.begin_step(elements_, this->grid_.nodes());
    }
  }

  /// Newton's iterations of one step; true when it converged.
  bool solve_step(double start, double step, StepStats& stats) {
    prepare(start, step);
    const ImplicitControls& o = controls_;
    if (o.newton.iterations == 1) return solve_once(stats);
    double best = 1e300;  // least unbalanced force so far
    int waited = 0;       // iterations since it was halved
    LinearForcing forcing;
    measure_stress(true);
    for (stats.newton = 0; stats.newton < o.newton.iterations; ++stats.newton) {
      bool changed = false;
      Balance balance = decide_contacts(changed);
      const double size = force_size(balance, stopping_share());
      stats.residual = std::sqrt(balance.residual) / size;
      if (!std::isfinite(stats.residual)) return false;
      if (stats.residual <= o.newton.tolerance && !changed) {
        const double moved = farthest_move();
        if (moved > 1) return false;
        if (!corner_.creeps(moved * std::min(this->frame_.cell[0], this->frame_.cell[2]))) {
          corner_.sharpen(stats.newton);
          return true;
        }
        // Once more with a sharper corner, from here: a step that does not find its way there is cut.
        corner_.hone();
        waited = 0;
        best = 1e300;
        balance = decide_contacts(changed);
        stats.residual = std::sqrt(balance.residual) / size;
        if (stats.residual <= o.newton.tolerance) continue;
      }
      waited = stats.residual < 0.5 * best ? 0 : waited + 1;
      best = std::min(best, stats.residual);
      if (waited >= FrictionCorner::patience && corner_.blunt()) {
        waited = 0;
        best = 1e300;
      }
      if (!linear_solve(stats, forcing.next(stats.residual, o.newton))) return false;
      if (search(std::sqrt(balance.residual), size)) continue;
      if (!corner_.blunt()) return false;
      measure_stress(true);  // where the search began
    }
    return false;
  }

  /// The reference paper: one solve with the tangent at the start of the step.
  bool solve_once(StepStats& stats) {
    measure_stress(true);
    measure_residual(true);
    stats.newton = 1;
    const bool solved = linear_solve(stats, controls_.newton.linear_tolerance);
    axpby(1.0, change_, 1.0, u_);
    stats.residual = stats.linear_residual;
    return solved && farthest_move() <= 1;
  }

  /// u += s change with the largest s = 1, 1/2, 1/4 ... after which less force is unbalanced, or less of it along the
  /// change: a sheet that must turn passes through larger forces on its way, but downhill in energy. Leaves the
  /// tangents there too: the first share is nearly always taken, and the next iteration begins with them.
  bool search(double before, double size) {
    copy(u_, saved_u_);
    const double downhill = std::abs(dot(residual_, change_));
    double share = 1;
    for (int halving = 0; halving < 10; ++halving, share *= 0.5) {
      axpby(share, change_, 1.0, u_);
      sum_each<1>(Device{}, count_, sums_, StickReversed{nodes(), held(), saved_u_.data()},
                  FinishReversals{balance_.data()});
      measure_stress(true);
      const Balance balance = measure_residual(false);
      const bool stuck = balance.changes > 0;
      const double after = std::sqrt(balance.residual), along = std::abs(balance.along);
      if (std::isfinite(after) && (after < before * (1 - 1e-4 * share) || along < 0.8 * downhill)) return true;
      if (stuck && after < 2 * before) return true;  // another active set: Newton goes on with that
      // The change that must be made at the end of convergence is rounding: take it.
      if (halving == 0 && after <= 1e-11 * size) return true;
      copy(saved_u_, u_);
    }
    return false;
  }

  bool linear_solve(StepStats& stats, double tolerance) {
    const bool direct = controls_.linear.solver == LinearSolver::cholesky;
    LinearReport report = direct ? factorise() : iterate(tolerance);
    stats.linear += report.iterations;
    if (report.indefinite) {
      stats.indefinite = true;
      // Compression makes the tangent of a sparsely filled cell indefinite; without that part it is one of a convex
      // energy, slower but sure to lead downhill.
      measure_stress(true, true);
      report = direct ? factorise() : iterate(tolerance);
      stats.linear += report.iterations;
    }
    stats.linear_residual = report.residual;
    return report.converged;
  }

  PointTangents<Real> point_tangents() { return {this->grid_.view(), points_.view(), tangents(), means(), springs()}; }

  /// What stands on the diagonal beside the points' stiffness.
  HeldNodes held_nodes() {
    stiffness_.resize(static_cast<std::size_t>(count_));
    for_each(Device{}, count_, FrictionStiffness{nodes(), held(), stiffness_.data()});
    if (contact_.on())
      contact_.each(AddContactDiagonal<Real, Shape>{this->grid_.view(), contact_.view(), mass_.data(),
                                                    contact_stiffness_.data(), stiffness_.data()});
    return {count_, mass_.data(), freed_.data(), scheme_.inertia(), dynamic_ ? 0 : static_shift, stiffness_.data()};
  }

  LinearReport factorise() { return cholesky_.solve(point_tangents(), held_nodes(), residual_, change_); }

  void refresh_operator() {
    const ProfilePhase<Device> phase("operator and preconditioner");
    preconditioner_.refresh(point_tangents(), this->grid_.groups(), elements_,
                            {this->grid_.view(), this->grid_.active_list(), this->grid_.active_blocks()}, held_nodes());
    operator_.refresh(point_tangents(), this->grid_.groups());
  }

  LinearReport iterate(double tolerance) {
    refresh_operator();
    const ProfilePhase<Device> phase("conjugate gradients");
    const ImplicitControls& o = controls_;
    const KrylovLimits limits{tolerance, o.linear.iterations};
    TangentProduct product{*this};
    return o.linear.solver == LinearSolver::pcg ? cg_.solve(product, preconditioner_, residual_, change_, limits)
                                                : bicgstab_.solve(product, preconditioner_, residual_, change_, limits);
  }

  /// The tangent of the step as Krylov methods take it.
  struct TangentProduct {
    ImplicitSolverOf& solver;
    void add_product(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted) {
      solver.operator_.apply(x, y, halted);
      if (!solver.contact_.on()) return;
      solver.contact_.each(ApplyContacts<Real, Shape>{solver.grid_.view(), solver.contact_.view(), solver.mass_.data(),
                                                      solver.contact_stiffness_.data(), x.data(), y.data()});
    }
    CloseProduct closing(const NodeVector<Device>& x, NodeVector<Device>& y) {
      return {solver.nodes(), solver.held(), solver.scheme_.inertia(), x.data(), y.data()};
    }
  };

  /// How far the points move [cells]. Shape functions stand still during a step, and points must not outrun them: one
  /// cell at most.
  double farthest_move() {
    farthest_.upload({0});
    for_each(Device{}, points_.count(),
             MeasureMotion<Real, Shape>{this->grid_.view(), points_.view(), u_.data(), dynamic_, farthest_.data()});
    return static_cast<double>(positive_from_bits(farthest_.download().front()));
  }

  void accept(const Clock& clock, double step) {
    const ProfilePhase<Device> phase("grid to points");
    if (contact_.on()) {
      contact_.each(KeepContacts<Real, Shape>{this->grid_.view(), contact_.view(), nodes(), contact_numbers(), step,
                                              dynamic_ ? impulses_.impulses() : nullptr});
    }
    for_each(Device{}, count_, EndOfStep{nodes(), scheme_, velocity_end_.data(), acceleration_end_.data()});
    AcceptStep<Real, Shape> step_kernel{this->grid_.view(),
                                        points_.view(),
                                        materials_,
                                        clock_.data(),
                                        nodes(),
                                        dynamic_ ? velocity_end_.data() : nullptr,
                                        acceleration_end_.data(),
                                        u_.data(),
                                        clock.share_kept(step, rate_),
                                        affine_,
                                        dilatant_,
                                        true,
                                        true,
                                        means()};
    const bool musl = dynamic_ && controls_.remaps_velocity;
    if (musl) {
      step_kernel.deforms = false;
      for_each(Device{}, points_.count(), step_kernel);
      change_.fill_zero();
      scatter_points(Device{}, points_.count(), this->grid_.groups(),
                     ScatterVelocity<Real, Shape>{{this->grid_.view(), points_.view()}, materials_, change_.data()});
      for_each(Device{}, count_, RemapDisplacement{nodes(), step, change_.data()});
      average(change_);
      step_kernel.strain_displacement = change_.data();
      step_kernel.deforms = true;
      step_kernel.speeds = false;
    } else {
      average(u_);
    }
    for_each(Device{}, points_.count(), step_kernel);
    this->measure_columns();
    for_each(Device{}, this->grid_.active_blocks() * block_columns,
             RecordColumns<Real>{
                 this->grid_.view(), this->grid_.active_list(), mass_.data(), dynamic_ ? velocity_end_.data() : nullptr,
                 static_cast<double>(materials_.list[0].density), this->column_volumes(), clock.time, this->maps()});
  }

  ImplicitControls controls_;
  bool affine_, dynamic_;
  BedOn<double, Device> node_bed_;
  double step_;
  int count_ = 0;
  bool first_;   // no acceleration is known yet
  bool midway_;  // the run began with explicit steps
  bool single_;  // tangents and operator in single precision: Newton's steps correct what that rounds off
  TimeScheme scheme_;
  Buffer<double, Device> springs_, grips_, tractions_, limits_;  // of the contact points
  Buffer<Sym3<double>, Device> contact_stiffness_;
  Buffer<double, Device> mass_, contact_friction_, traction_, friction_limit_;
  double rate_ = 0;  // CFL steps per time, as the last step ended [1/s]
  FrictionCorner corner_;
  ElementList<Real, Device, Shape> elements_;
  MeanDilation<Real, Device, Shape> means_;
  Walls<double> walls_;
  NodeVector<Device> velocity_, arrival_, acceleration_, external_, internal_, u_, residual_, normal_, along_,
      velocity_end_, acceleration_end_, change_, saved_u_;
  Buffer<Sym3<double>, Device> freed_, wall_freed_, stiffness_;
  Buffer<Touch, Device> touch_;
  Buffer<unsigned char, Device> wavers_;  // changes between stick and slip
  Buffer<Real, Device> tangents_;
  Buffer<float, Device> single_tangents_;
  Buffer<Balance, Device> balance_;
  Buffer<std::uint32_t, Device> farthest_;
  ConjugateGradient<Device> cg_;
  BiCgStab<Device> bicgstab_;
  TangentOperator<Real, Device, Shape> operator_;
  NodePreconditioner<Real, Device, Shape> preconditioner_;
  CholeskySolver<Real, Device, Shape> cholesky_;
};

/// A solver of one precision in the place asked for.
template <class Real>
std::unique_ptr<Solver> make_implicit_solver_of(const Scene& scene, const IntegratorSettings& settings,
                                                const ImplicitControls& controls, On on, const SolverState& state) {
  return with_shape(settings.shape, [&](auto shape) -> std::unique_ptr<Solver> {
    using Shape = decltype(shape);
#if TALUS_FOR_GPU
    if (on == On::gpu)
      return std::make_unique<ImplicitSolverOf<Real, GpuDevice, Shape>>(scene, settings, controls, state);
#else
    static_cast<void>(on);
#endif
    return std::make_unique<ImplicitSolverOf<Real, CpuDevice, Shape>>(scene, settings, controls, state);
  });
}

}  // namespace talus::solver
