// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/simulation.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "solver/parallel/device.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/run/gravity_loading.hpp"
#include "solver/run/products.hpp"
#include "solver/run/progress.hpp"
#include "solver/run/recorders/check_checkpoint.hpp"
#include "solver/run/sanity.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {

Simulation::Simulation(const Domain& domain, const SolveOptions& options, const AnyDevice& device, RunPaths paths,
                       std::string fingerprint)
    : domain_(domain),
      options_(with_preset(options)),
      paths_(std::move(paths)),
      marks_{std::move(fingerprint)},
      scene_(make_scene(domain, options_)),
      schedule_(options_),
      stepper_(scene_, options_, device),
      history_(options_, scene_),
      watch_(scene_, options_),
      frames_(scene_, options_, paths_.frames, paths_.vdb_frames) {}

void Simulation::resume(const std::filesystem::path& file) {
  Checkpoint checkpoint = read_checkpoint(file, marks_.fingerprint);
  check_checkpoint(file, checkpoint, scene_);
  frames_.belong_to(checkpoint.id);
  frames_.expect(checkpoint.memory.frames);
  marks_.id = checkpoint.id;
  marks_.stop_reason = checkpoint.stop_reason;
  stepper_.begin(checkpoint.state);
  memory_ = std::move(checkpoint.memory);
  history_.restore(memory_);
  timer_.resume(memory_.wall_time);
  log_info(fmt::format("going on from {} at t = {:.3f} s, step {}", file.string(), stepper_.time(),
                       checkpoint.state.clock.step));
}

void Simulation::start() {
  marks_.id = new_run_id();
  frames_.belong_to(marks_.id);
  if (options_.gravity_loading_steps > 0) load_by_gravity(scene_, options_, stepper_.device());
  stepper_.begin(first_state(scene_, make_settings(options_, scene_.grid).common));
  for (const std::string& note : scene_.contacts.notes) log_info(note);
  memory_.initial_thickness = stepper_.solver().thickness();
}

RunSummary Simulation::run(const std::string& scene, const std::string& title, const Facts& made_by) {
  timer_.start();
  const bool fresh = !stepper_.begun();
  if (fresh) start();
  const OwnEnd saving("the state is saved at the next step that allows it");
  timer_.start();
  if (fresh) pass_events(0.0);
  if (marks_.stop_reason.empty()) {
    const std::string reason = step_to_end();
    if (schedule_.ends_between_frames(stepper_.time(), memory_)) put_frame(stepper_.time());
    marks_.stop_reason = reason;
  }
  RunSummary summary;
  summary.scene = scene;
  summary.title = title;
  summary.stop_reason = marks_.stop_reason;
  summary.provenance = domain_.provenance;
  summary.provenance.emplace_back(run_id, marks_.id);
  summary.provenance.insert(summary.provenance.end(), made_by.begin(), made_by.end());
  return finish(std::move(summary));
}

/// The method steps to the end and returns why it stopped.
std::string Simulation::step_to_end() {
  Progress progress;
  while (stepper_.time() < schedule_.end_time()) {
    const BatchReport batch = stepper_.advance(schedule_.next_event(stepper_.time(), memory_));
    count(batch);
    stop_or_save(batch);
    if (batch.clock.halt == at_event) pass_events(stepper_.time());
    if (progress.due())
      progress.update(progress_line(batch.clock, {schedule_.end_time(), mass_error(), timer_.seconds()}));
    if (calm()) return fmt::format("kinetic energy below {:g} of its peak", options_.stop_kinetic_fraction);
    if (stepper_.solver().particle_count() == 0) return "all material left the domain";
  }
  return "end of the simulated time";
}

void Simulation::count(const BatchReport& batch) {
  memory_.outflow_volume += batch.outflow_volume;
  memory_.outflow_count += batch.outflow_count;
  if (batch.clock.halt == failed)
    refuse_lost_point(batch.clock, stepper_.solver().state().points, scene_.map, options_.cfl);
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

/// The method stops or saves where it must; points can be written down only after a sort.
void Simulation::stop_or_save(const BatchReport& batch) {
  if (!batch.sorted) return;
  const double time = stepper_.time();
  const bool due = schedule_.checkpoint_due(time, memory_), stopped = interrupted();
  if (due) ++memory_.checkpoints;
  if (due || stopped) save_checkpoint();
  if (stopped) stop();
}

/// The run file of many points takes long to write. The checkpoint says that there is no step left to take.
void Simulation::stop_if_interrupted_at_the_end() {
  if (!interrupted()) return;
  save_checkpoint();
  stop();
}

void Simulation::stop() {
  throw Interrupted({fmt::format("stopped at t = {:.3f} s, step {}", stepper_.time(), stepper_.solver().clock().step),
                     "interrupted",
                     fmt::format("Go on with --restart; {} holds the state", paths_.checkpoint.string())});
}

void Simulation::pass_events(double time) {
  if (schedule_.record_due(time, memory_)) record(time);
  if (schedule_.frame_due(time, memory_)) put_frame(time);
}

void Simulation::record(double time) {
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
}

void Simulation::put_frame(double time) {
  frames_.put(time, memory_.frames, stepper_.solver());
  ++memory_.frames;
}

void Simulation::save_checkpoint() {
  memory_.wall_time = timer_.seconds();
  history_.keep(memory_);
  frames_.settle();  // a checkpoint counts on its frames
  write_checkpoint(paths_.checkpoint,
                   {marks_.fingerprint, marks_.id, marks_.stop_reason, stepper_.solver().state(), memory_});
  frames_.drop_others();  // of the run whose checkpoint this one has replaced
}

bool Simulation::calm() const {
  return options_.stop_kinetic_fraction > 0 && stepper_.time() >= scene_.shaking.end() &&
         history_.last("kinetic_J") < options_.stop_kinetic_fraction * memory_.peak_kinetic;
}

/// The error of the mass by the last record, over the volume of the first [-].
double Simulation::mass_error() const {
  const std::vector<double>& volumes = history_.rows().at("volume_m3").values;
  return volumes.empty() ? 0 : (volumes.back() + history_.last("outflow_m3")) / volumes.front() - 1;
}

void Simulation::report_sanity(const RunSanity& sanity) const {
  log_info(sanity_line(sanity));
  for (const std::string& fault : insane(sanity)) log_warning(fault);
}

void Simulation::measure(const RunEnd& end, RunSummary& summary) const {
  const Solver& solver = stepper_.solver();
  const AnyDevice& device = stepper_.device();
  summary.on = device.is_gpu() ? gpu_name(device.gpu().index()) : hardware();
  summary.material = options_.material.sentence();
  summary.bed = options_.base.sentence();
  summary.precision = options_.precision == Precision::double_ ? "double" : "single";
  summary.version = version();
  summary.particles = static_cast<std::int64_t>(scene_.points.size());
  summary.particles_outflow = memory_.outflow_count;
  summary.steps = end.state.clock.step;
  summary.time_end = stepper_.time();
  summary.wall_time = memory_.wall_time;
  summary.memory = static_cast<double>(solver.bytes());
  for (const auto& [owner, bytes] : solver.memory()) summary.memory_of.emplace_back(owner, static_cast<double>(bytes));
  for (const Profile::Phase& p : device.profile().phases()) summary.profile.emplace_back(p.name, p.seconds);
  summary.density = options_.material.density;
  for (const std::string& release : domain_.release_names)
    summary.release_density.push_back(options_.material_of(release).density);
  summary.layer_height = domain_.layer_height;
  const SlideVolumes volumes = slide_volumes(end, memory_.outflow_volume);
  summary.volume_released = volumes.released;
  summary.volume_entrained = volumes.entrained;
  summary.volume_final = volumes.final;
  summary.volume_outflow = memory_.outflow_volume;
  summary.sanity = sanity_of(end, history_.rows(), memory_.outflow_volume);
}

RunSummary Simulation::finish(RunSummary summary) {
  const SolverState state = stepper_.solver().state();
  memory_.wall_time = timer_.seconds();
  const RunEnd end{.domain = domain_,
                   .options = options_,
                   .scene = scene_,
                   .state = state,
                   .initial_thickness = memory_.initial_thickness};
  measure(end, summary);
  write_run(end, summary);
  for (const std::string& line : history_.conclusions()) log_info(line);
  for (const std::string& line : history_.warnings()) log_warning(line);
  report_sanity(summary.sanity);
  log_detail(fmt::format("files: {:.1f} s after the last step", timer_.seconds() - memory_.wall_time));
  remove_for_good(paths_.checkpoint);  // the run is whole: nothing is left to go on with
  frames_.clear();                     // after the checkpoint that counts on them
  frames_.drop_older_vdb(memory_.frames);
  return summary;
}

/// The method writes run.h5, which takes the place of an older one once it is whole.
void Simulation::write_run(const RunEnd& end, const RunSummary& summary) {
  frames_.settle();
  RunWriter writer(paths_.run);
  for (std::int64_t number = 0; number < memory_.frames; ++number) {
    stop_if_interrupted_at_the_end();
    frames_.append_to(writer, number);
  }
  writer.finish(final_maps(end, stepper_.solver().thickness()), history_.rows(), summary);
}

}  // namespace talus::solver
