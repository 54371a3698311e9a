// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_loop.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

/// The loaded strains go to the points of the start, which are in another order, as far as their law keeps them.
void take_strains(const ParticleState& loaded, const SolveOptions& options, ParticleState& start) {
  for (std::size_t q = 0; q < loaded.size(); ++q) {
    const auto p = static_cast<std::size_t>(loaded.id[q]);
    const std::size_t material = start.material_of(p);
    const MaterialOptions& own = material > 0 ? options.parts[material - 1].material : options.material;
    const auto& e = loaded.elastic;
    const Sym3<double> kept = after_loading(own.model, {e[0][q], e[1][q], e[2][q], e[3][q], e[4][q], e[5][q]});
    const double values[6] = {kept.xx, kept.yy, kept.zz, kept.xy, kept.yz, kept.xz};
    for (std::size_t a = 0; a < 6; ++a) start.elastic[a][p] = values[a];
    start.log_volume[p] = loaded.log_volume[q];
  }
}

std::vector<double> times_of(const Inflow& inflow) {
  std::vector<double> times;
  for (const InflowPulse& pulse : inflow.pulses) times.push_back(pulse.time);
  return times;
}

}  // namespace

Schedule::Schedule(const SolveOptions& options, std::vector<double> pulses)
    : frame_interval_(options.frame_interval),
      record_interval_(options.history_interval),
      checkpoint_interval_(options.checkpoint_interval),
      end_time_(options.end_time),
      pulses_(std::move(pulses)) {
  for (const WallOptions& wall : options.walls) changes_.push_back(wall.to);
  for (const LoadOptions& load : options.loads) changes_.insert(changes_.end(), {load.from, load.to});
  if (options.shaking.acts()) changes_.push_back(options.shaking.start);
}

double Schedule::next_event(double time, const RunMemory& passed) const {
  double next =
      std::min({at_count(passed.frames, frame_interval_), at_count(passed.records, record_interval_), end_time_});
  for (const double change : changes_)
    if (change > just_after(time)) next = std::min(next, change);
  if (expects_pulses(passed)) next = std::min(next, pulses_[static_cast<std::size_t>(passed.pulses)]);
  return just_after(next) >= end_time_ ? end_time_ : next;
}

ParticleState loaded_by_gravity(const Scene& scene, const SolveOptions& options, const AnyDevice& device) {
  Scene resting = scene;
  resting.shaking = {};
  for (auto& component : resting.points.velocity) std::fill(component.begin(), component.end(), 0.0);
  const SolverSettings settings = make_settings(options, resting.grid);
  const auto loader = make_solver(resting, for_gravity_loading(settings, options.gravity_loading_steps), device);
  loader->set_next_event(1);
  log_info(fmt::format("gravity is brought on first, in {} steps at least", options.gravity_loading_steps));
  std::int64_t newton = 0, linear = 0;
  while (loader->clock().time < 1) {
    stop_if_interrupted("bringing on gravity");
    const BatchReport batch = loader->advance();
    newton += batch.stats.newton;
    linear += batch.stats.linear;
  }
  ParticleState start = scene.points;
  take_strains(loader->state().points, options, start);
  log_info(fmt::format("gravity loading: {} steps, {} Newton and {} linear iterations", loader->clock().step, newton,
                       linear));
  return start;
}

RunLoop::RunLoop(std::shared_ptr<const Plan> plan, const AnyDevice& device, HistoryUse use)
    : plan_(std::move(plan)),
      schedule_(options(), times_of(scene().inflow)),
      stepper_(scene(), options(), device),
      history_(options(), scene(), use),
      watch_(scene(), options()) {}

void RunLoop::start() {
  const bool loads = options().gravity_loading_steps > 0 && scene().points.size() > 0;
  const ParticleState loaded = loads ? loaded_by_gravity(scene(), options(), stepper_.device()) : ParticleState{};
  stepper_.begin(first_state(scene(), make_settings(options(), scene().grid).common, loads ? loaded : scene().points));
  for (const std::string& note : scene().contacts.notes) log_info(note);
  memory_.initial_thickness = stepper_.solver().thickness();
}

void RunLoop::resume(const SolverState& state, RunMemory memory) {
  history_.restore(memory);
  stepper_.begin(state);
  memory_ = std::move(memory);
}

std::string RunLoop::step_to_end(RunKeeper& keeper, bool fresh) {
  if (fresh) pass_events(0.0, keeper);
  std::string reason = "end of the simulated time";
  while (!stopped_ && stepper_.time() < schedule_.end_time()) {
    const BatchReport batch = stepper_.advance(schedule_.next_event(stepper_.time(), memory_));
    count(batch);
    bool can_be_saved = batch.can_be_saved;
    if (batch.clock.alarms.halt == at_event) {
      if (let_in(stepper_.time())) can_be_saved = true;  // what enters is sorted with the others
      pass_events(stepper_.time(), keeper);
    }
    keeper.pass_batch(batch);
    if (calm()) {
      reason = fmt::format("kinetic energy below {:g} of its peak", options().stop_kinetic_fraction);
      break;
    }
    if (stepper_.solver().particle_count() == 0 && !schedule_.expects_pulses(memory_)) {
      reason = "all material left the domain";
      break;
    }
    if (!can_be_saved) continue;
    const bool due = schedule_.checkpoint_due(stepper_.time(), memory_);
    if (due) ++memory_.checkpoints;
    keeper.pass_whole_state(due);
  }
  if (stopped_) reason = "stopped by the caller";
  if (schedule_.ends_between_frames(stepper_.time(), memory_)) put_frame(stepper_.time(), keeper);
  return reason;
}

/// The method lets in what the inflows have brought by `time` and returns whether that is anything. The time is that of
/// an event: those who left have been dropped.
bool RunLoop::let_in(double time) {
  const std::int64_t before = memory_.pulses;
  while (schedule_.pulse_due(time, memory_)) {
    const InflowPulse& pulse = scene().inflow.pulses[static_cast<std::size_t>(memory_.pulses)];
    stepper_.add(scene().inflow.points_of(pulse));
    ++memory_.pulses;
  }
  return memory_.pulses > before;
}

void RunLoop::count(const BatchReport& batch) {
  memory_.outflow_volume += batch.outflow_volume;
  memory_.outflow_count += batch.outflow_count;
  if (batch.clock.alarms.halt == failed)
    refuse_lost_point(batch.clock, stepper_.solver().state().points, scene().map, options().step_over_cfl());
  watch_.look(batch);
  if (batch.stats.newton == 0) return;
  memory_.newton += batch.stats.newton;
  memory_.linear += batch.stats.linear;
  memory_.cuts += batch.stats.cuts;
  log_detail(fmt::format(
      "step {}  t {:.6g} s  dt {:.3g} s ({:.3g} CFL)  newton {}  cg {}  unbalanced {:.1e}  cuts {}{}", batch.clock.step,
      batch.clock.time, batch.clock.step_size, stepper_.over_cfl(), batch.stats.newton, batch.stats.linear,
      batch.stats.residual, batch.stats.cuts, batch.stats.indefinite ? "  indefinite tangent, convex part taken" : ""));
}

void RunLoop::pass_events(double time, RunKeeper& keeper) {
  if (schedule_.record_due(time, memory_)) record(time, keeper);
  if (schedule_.frame_due(time, memory_)) put_frame(time, keeper);
}

void RunLoop::record(double time, RunKeeper& keeper) {
  Solver& solver = stepper_.solver();
  const Energies energies = solver.energies();
  memory_.peak_kinetic = std::max(memory_.peak_kinetic, energies.kinetic);
  history_.record({.time = time,
                   .clock = solver.clock(),
                   .energies = energies,
                   .step_over_cfl = stepper_.over_cfl(),
                   .counted = memory_,
                   .solver = solver});
  ++memory_.records;
  if (!keeper.pass_record(time)) stopped_ = true;
}

void RunLoop::put_frame(double time, RunKeeper& keeper) {
  keeper.put_frame(time);
  ++memory_.frames;
}

bool RunLoop::calm() const {
  return options().stop_kinetic_fraction > 0 && stepper_.time() >= scene().shaking.end() &&
         !schedule_.expects_pulses(memory_) &&
         history_.last("kinetic_J") < options().stop_kinetic_fraction * memory_.peak_kinetic;
}

double RunLoop::mass_error() const {
  const std::vector<double>& volumes = history_.rows().at("volume_m3").values;
  if (volumes.empty()) return 0;
  const double entered = volumes.front() + history_.last("inflow_m3");
  return entered > 0 ? (volumes.back() + history_.last("outflow_m3")) / entered - 1 : 0;
}

RunEnd RunLoop::end(const SolverState& state) const {
  return {.domain = *plan_->domain,
          .options = options(),
          .scene = scene(),
          .state = state,
          .initial_thickness = memory_.initial_thickness,
          .pulses = memory_.pulses};
}

void RunLoop::measure(const RunEnd& end, RunSummary& summary) const {
  const Solver& solver = stepper_.solver();
  const AnyDevice& device = stepper_.device();
  summary.on = hardware_of(device);
  summary.material = options().material.sentence();
  summary.bed = bed_sentence(end.domain, end.options);
  summary.precision = options().precision == Precision::double_ ? "double" : "single";
  summary.version = version();
  summary.particles = static_cast<std::int64_t>(scene().points.size() + scene().inflow.points_in(memory_.pulses));
  summary.particles_outflow = memory_.outflow_count;
  summary.steps = end.state.clock.step;
  summary.time_end = stepper_.time();
  summary.wall_time = memory_.wall_time;
  summary.memory = static_cast<double>(solver.bytes());
  for (const auto& [owner, bytes] : solver.memory()) summary.memory_of.emplace_back(owner, static_cast<double>(bytes));
  for (const Profile::Phase& p : device.profile().phases()) summary.profile.emplace_back(p.name, p.seconds);
  summary.density = options().material.density;
  for (const std::string& release : end.scene.release_names)
    summary.release_density.push_back(options().material_of(release).density);
  summary.layer_height = end.domain.layer_height;
  const SlideVolumes volumes = slide_volumes(end, memory_.outflow_volume);
  summary.volume_released = volumes.released;
  summary.volume_entrained = volumes.entrained;
  summary.volume_final = volumes.final;
  summary.volume_outflow = memory_.outflow_volume;
  summary.sanity = sanity_of(end, history_.rows(), memory_.outflow_volume);
}

}  // namespace talus::solver
