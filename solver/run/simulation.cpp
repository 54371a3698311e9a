// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/simulation.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/stage/checksum.hpp"

namespace talus::solver {

SolveOptions options_of(const recipe::Recipe& recipe, const std::filesystem::path& out) {
  SolveOptions options = with_preset(recipe.read<SolveOptions>("solve"));
  for (ObstacleOptions& obstacle : options.obstacles) {
    if (obstacle.body || !obstacle.level_set.empty()) continue;
    obstacle.level_set = out / "obstacles.vdb";
    if (obstacle.grid.empty()) obstacle.grid = obstacle.name;
  }
  return options;
}

std::vector<std::filesystem::path> inputs_of(const SolveOptions& options, const std::filesystem::path& out) {
  std::vector<std::filesystem::path> inputs{options.domain.empty() ? out / "domain.vdb" : options.domain};
  for (const ObstacleOptions& obstacle : options.obstacles)
    if (std::find(inputs.begin(), inputs.end(), obstacle.level_set) == inputs.end())
      inputs.push_back(obstacle.level_set);
  for (const InflowOptions& inflow : options.inflows)
    if (!inflow.file.empty()) inputs.push_back(inflow.file);
  if (options.shaking.acts()) inputs.push_back(options.shaking.file);
  return inputs;
}

std::string fingerprint_of(const std::filesystem::path& domain, const SolveOptions& options) {
  std::string fingerprint = checksum_as_read(domain) + "\n" + recipe::to_toml(options, "solve", false);
  for (const ObstacleOptions& obstacle : options.obstacles) fingerprint += sha256(obstacle.level_set) + "\n";
  for (const InflowOptions& inflow : options.inflows)
    if (!inflow.file.empty()) fingerprint += sha256(inflow.file) + "\n";
  if (options.shaking.acts()) fingerprint += sha256(options.shaking.file) + "\n";
  return fingerprint;
}

Facts made_by(const StageContext& context, const SolveOptions& o) {
  Facts facts{{recipe_of_run, recipe_mark(context.recipe, "solve")}};
  for (std::size_t n = 0; n < o.inflows.size(); ++n)
    if (!o.inflows[n].file.empty())
      facts.emplace_back("hydrograph." + inflow_name(o.inflows[n], n) + ".sha256", sha256(o.inflows[n].file));
  if (o.shaking.acts()) facts.emplace_back(shaking_checksum, sha256(o.shaking.file));
  return facts;
}

void judge_inputs(const StageContext& context, const SolveOptions& o, const std::filesystem::path& file,
                  const Domain& domain) {
  judge_maker(context.recipe, {.file = file,
                               .table = "preprocess",
                               .mark = fact(domain.provenance, recipe_of_domain),
                               .program = "talus-preprocess",
                               .key = "domain in [solve]",
                               .named = !o.domain.empty()});
  const std::string written = fact(domain.provenance, obstacles_checksum);
  const auto bodies = context.out / "obstacles.vdb";
  const auto reads = [&](const ObstacleOptions& obstacle) { return obstacle.level_set == bodies; };
  if (!written.empty() && std::filesystem::exists(bodies) &&
      std::any_of(o.obstacles.begin(), o.obstacles.end(), reads)) {
    if (const std::string found = sha256(bodies); found != written)
      throw DataError(
          {bodies.string() + ": not the file that was written with " + file.string(),
           fmt::format("its SHA-256 is {:.16}..., that of the file written with it {:.16}...", found, written),
           "Run talus-preprocess again"});
  }
}

void remove_leftovers(const RunPaths& paths) {
  remove_for_good(paths.checkpoint);  // before the frames that it counts on
  std::error_code ignored;
  std::filesystem::remove_all(paths.frames, ignored);
}

Simulation::Simulation(std::shared_ptr<const Plan> plan, const AnyDevice& device, RunPaths paths,
                       std::string fingerprint)
    : paths_(std::move(paths)),
      marks_{std::move(fingerprint)},
      loop_(std::move(plan), device),
      frames_(loop_.scene(), loop_.options(), paths_.frames, paths_.run) {}

void Simulation::resume(const std::filesystem::path& file) {
  Checkpoint checkpoint = read_checkpoint(file, marks_.fingerprint);
  check_checkpoint(file, checkpoint, loop_.scene());
  frames_.belong_to(checkpoint.id);
  frames_.go_on_after(checkpoint.memory.frames);
  marks_.id = checkpoint.id;
  marks_.stop_reason = checkpoint.stop_reason;
  timer_.resume(checkpoint.memory.wall_time);
  loop_.resume(checkpoint.state, std::move(checkpoint.memory));
  log_info(fmt::format("going on from {} at t = {:.3f} s, step {}", file.string(), loop_.stepper().time(),
                       checkpoint.state.clock.step));
}

RunSummary Simulation::run(const std::string& scene, const std::string& title, const std::optional<Facts>& facts,
                           const std::optional<std::vector<Finding>>& findings) {
  const Findings found("solve", loop_.options().accept);
  timer_.start();
  const bool fresh = !loop_.stepper().begun();
  if (fresh) {
    marks_.id = new_run_id();
    frames_.belong_to(marks_.id);
    Profile& profile = loop_.stepper().device().profile();
    const bool measured = profile.on();
    profile.turn_off();  // the wall time is that of the steps
    loop_.start();
    if (measured) profile.turn_on();
  }
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

void Simulation::pass_whole_state(bool checkpoint_due) {
  const bool stopped = interrupted();
  if (checkpoint_due || stopped) save_checkpoint();
  if (stopped) stop();
}

void Simulation::pass_batch(const BatchReport& batch) {
  if (progress_ && progress_->due())
    progress_->update(progress_line(batch.clock, {loop_.end_time(), loop_.mass_error(), timer_.seconds(),
                                                  loop_.options().stop_kinetic_fraction > 0}));
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
  frames_.save(memory.frames);  // a checkpoint counts on its frames
  write_checkpoint(paths_.checkpoint,
                   {marks_.fingerprint, marks_.id, marks_.stop_reason, loop_.stepper().solver().state(), memory});
  frames_.drop_others();  // of the run whose checkpoint this one has replaced
}

RunSummary Simulation::finish(RunSummary summary, const Findings& found) {
  const SolverState state = loop_.stepper().solver().end_state();
  loop_.memory().wall_time = timer_.seconds();
  const RunEnd end = loop_.end(state);
  loop_.measure(end, summary);
  loop_.history().conclude();
  say_sanity(summary.sanity);
  summary.findings.insert(summary.findings.end(), found.list().begin(), found.list().end());
  write_run(end, summary);
  log_detail(fmt::format("files: {:.1f} s after the last step", timer_.seconds() - loop_.memory().wall_time));
  remove_leftovers(paths_);
  return summary;
}

/// The method writes run.h5, which takes the place of an older one once it is whole.
void Simulation::write_run(const RunEnd& end, const RunSummary& summary) {
  RunWriter& writer = frames_.whole(loop_.memory().frames, [this] {
    if (!interrupted()) return;  // the file of many points takes long; the checkpoint says that no step is left
    save_checkpoint();
    stop();
  });
  writer.finish(final_maps(end, loop_.stepper().solver().thickness()), loop_.history().rows(), summary);
}

}  // namespace talus::solver
