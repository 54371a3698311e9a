// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/simulation.hpp"

#include <utility>

#include <fmt/format.h>

#include "solver/run/products.hpp"
#include "solver/run/progress.hpp"
#include "solver/run/recorders/check_checkpoint.hpp"
#include "solver/run/recorders/frame_store.hpp"
#include "solver/run/sanity.hpp"

namespace talus::solver {
void remove_leftovers(const RunPaths& paths) {
  remove_for_good(paths.checkpoint);
  FrameStore(paths.frames).clear();
}

Simulation::Simulation(std::shared_ptr<const Plan> plan, const AnyDevice& device, RunPaths paths,
                       std::string fingerprint)
    : paths_(std::move(paths)),
      marks_{std::move(fingerprint)},
      loop_(std::move(plan), device),
      frames_(loop_.scene(), loop_.options(), paths_.frames) {}

void Simulation::resume(const std::filesystem::path& file) {
  Checkpoint checkpoint = read_checkpoint(file, marks_.fingerprint);
  check_checkpoint(file, checkpoint, loop_.scene());
  frames_.belong_to(checkpoint.id);
  frames_.expect(checkpoint.memory.frames);
  marks_.id = checkpoint.id;
  marks_.stop_reason = checkpoint.stop_reason;
  timer_.resume(checkpoint.memory.wall_time);
  loop_.resume(checkpoint.state, std::move(checkpoint.memory));
  log_info(fmt::format("going on from {} at t = {:.3f} s, step {}", file.string(), loop_.stepper().time(),
                       checkpoint.state.clock.step));
}

void Simulation::start() {
  marks_.id = new_run_id();
  frames_.belong_to(marks_.id);
  loop_.start();
}

RunSummary Simulation::run(const std::string& scene, const std::string& title, const std::optional<Facts>& facts,
                           const std::optional<std::vector<Finding>>& findings) {
  const Findings found("solve", loop_.options().accept);
  timer_.start();
  const bool fresh = !loop_.stepper().begun();
  if (fresh) start();
  const OwnEnd saving("the state is saved at the next step that allows it");
  timer_.start();
  if (marks_.stop_reason.empty()) {
    progress_.emplace();
    marks_.stop_reason = loop_.step_to_end(*this, fresh);
    progress_.reset();
  }
  RunSummary summary;
  summary.scene = scene;
  summary.title = title;
  summary.stop_reason = marks_.stop_reason;
  summary.provenance = facts.value_or(loop_.plan().domain->provenance);
  summary.provenance.emplace_back(run_id, marks_.id);
  summary.places = places_of(loop_.plan());
  summary.findings = findings ? *findings : findings_of(loop_.plan());
  return finish(std::move(summary), found);
}

void Simulation::put_frame(double time, std::int64_t number) { frames_.put(time, number, loop_.stepper().solver()); }

void Simulation::pass_whole_state(bool checkpoint_due) {
  const bool stopped = interrupted();
  if (checkpoint_due || stopped) save_checkpoint();
  if (stopped) stop();
}

void Simulation::pass_batch(const BatchReport& batch) {
  if (progress_ && progress_->due())
    progress_->update(progress_line(batch.clock, {loop_.end_time(), loop_.mass_error(), timer_.seconds()}));
}

/// The run file of many points takes long to write. The checkpoint says that there is no step left to take.
void Simulation::stop_if_interrupted_at_the_end() {
  if (!interrupted()) return;
  save_checkpoint();
  stop();
}

void Simulation::stop() {
  const Stepper& stepper = loop_.stepper();
  throw Interrupted({fmt::format("stopped at t = {:.3f} s, step {}", stepper.time(), stepper.solver().clock().step),
                     "interrupted",
                     fmt::format("Go on with --restart; {} holds the state", paths_.checkpoint.string())});
}

void Simulation::save_checkpoint() {
  RunMemory& memory = loop_.memory();
  memory.wall_time = timer_.seconds();
  loop_.history().keep(memory);
  frames_.settle();  // a checkpoint counts on its frames
  write_checkpoint(paths_.checkpoint,
                   {marks_.fingerprint, marks_.id, marks_.stop_reason, loop_.stepper().solver().state(), memory});
  frames_.drop_others();  // of the run whose checkpoint this one has replaced
}

RunSummary Simulation::finish(RunSummary summary, const Findings& found) {
  const SolverState state = loop_.stepper().solver().state();
  loop_.memory().wall_time = timer_.seconds();
  const RunEnd end = loop_.end(state);
  loop_.measure(end, summary);
  loop_.history().conclude();
  say_sanity(summary.sanity);
  summary.findings.insert(summary.findings.end(), found.list().begin(), found.list().end());
  write_run(end, summary);
  log_detail(fmt::format("files: {:.1f} s after the last step", timer_.seconds() - loop_.memory().wall_time));
  remove_for_good(paths_.checkpoint);  // the run is whole: nothing is left to go on with
  frames_.clear();                     // after the checkpoint that counts on them
  return summary;
}

/// The method writes run.h5, which takes the place of an older one once it is whole.
void Simulation::write_run(const RunEnd& end, const RunSummary& summary) {
  frames_.settle();
  RunWriter writer(paths_.run);
  for (std::int64_t number = 0; number < loop_.memory().frames; ++number) {
    stop_if_interrupted_at_the_end();
    frames_.append_to(writer, number);
  }
  writer.finish(final_maps(end, loop_.stepper().solver().thickness()), loop_.history().rows(), summary);
}

}  // namespace talus::solver
