// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/stage.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/domain/domain.hpp"
#include "common/domain/threads.hpp"
#include "common/ensemble/counts.hpp"
#include "common/ensemble/used.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/signals.hpp"
#include "solver/ensemble/ensemble_stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/plan/plan.hpp"
#include "solver/run/run_stage.hpp"
#include "solver/run/stability/stability_stage.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

const char* const examples =
    "  talus-solve recipe.toml --out out/valley            # as the recipe says, on a GPU where there is one\n"
    "  talus-solve recipe.toml --out out/valley --on cpu   # on the processor\n"
    "  talus-solve recipe.toml --out out/valley --restart  # go on after Ctrl-C\n"
    "  talus-solve recipe.toml --out out/valley --resume   # go on where there is something to go on from\n"
    "  talus-solve recipe.toml --out out/valley --plan     # say what is on, how many steps, how long; write nothing\n"
    "  talus-solve recipe.toml --out out/valley --members 0:250   # a part of an ensemble";

/// The arguments of the command line beyond those that every stage takes.
struct SolveFlags {
  On on = On::automatic;
  RunFlags run;
  std::optional<MemberRange> members;
  int at_a_time = 0;  // 0: as the program decides
};

/// The flags of talus-solve, each setting its member of `given`.
std::vector<Flag> flags_into(const std::shared_ptr<SolveFlags>& given) {
  return {{.name = "--on",
           .help = "Where to run; auto: on the GPU where there is one; gpus: one run on all GPUs of this machine",
           .choices = {std::begin(on_words), std::end(on_words)},
           .set = [given](const std::string& word) { given->on = *on_called(word); }},
          {.name = "--restart",
           .help = "Go on from a checkpoint (default: checkpoint.h5 in the results)",
           .value = "[FILE]",
           .set = [given](const std::string& file) { given->run.restart = file; }},
          {.name = "--resume",
           .help = "Go on from checkpoint.h5 in the results where it is one of this run, else begin anew",
           .set = [given](const std::string&) { given->run.resume = true; }},
          {.name = "--members",
           .help = "Of an ensemble, members A to B-1 alone, counted from 0; talus-postprocess adds parts up",
           .value = "A:B",
           .set = [given](const std::string& words) { given->members = member_range(words); }},
          {.name = "--at-a-time",
           .help = "Of an ensemble, runs at a time (default: one a thread; of a GPU what it gains from)",
           .value = "N",
           .set = [given](const std::string& words) { given->at_a_time = members_at_a_time(words); }},
          {.name = "--profile",
           .help = "Measure where the time goes, phase by phase and kernel by kernel; say it at the end, and in "
                   "profile.csv",
           .set = [given](const std::string&) { given->run.profile = true; }},
          {.name = "--plan",
           .help = "Say what is on, points, memory, steps and the time to expect; run and write nothing",
           .writes_nothing = true,
           .set = [given](const std::string&) { given->run.plan = true; }}};
}

/// The id in run.h5 or counts.h5.
std::string id_in(const std::filesystem::path& result) {
  const std::string name = result.filename().string();
  if (name == "run.h5") return fact(run_facts(result), run_id);
  return name.starts_with("counts") && name.ends_with(".h5") ? fact(counts_facts(result), domain_id) : "";
}

/// What the command line says of an ensemble, and what it cannot say.
EnsembleFlags ensemble_flags(const SolveFlags& flags) {
  if (flags.run.profile)
    throw RecipeError({"--profile", "members of an ensemble run at a time, and share the processor",
                       "Profile one of them: leave --profile out, or run with --set ensemble.members=0"});
  if (flags.run.restart && !flags.run.restart->empty())
    throw RecipeError({"--restart " + flags.run.restart->string(),
                       "an ensemble goes on from its own unfinished members", "Write --restart alone"});
  return {.on = flags.on,
          .members = flags.members,
          .restart = flags.run.restart.has_value(),
          .resume = flags.run.resume,
          .at_a_time = flags.at_a_time,
          .plan = flags.run.plan};
}

Dependencies depends(const StageContext& context, const SolveFlags& flags) {
  if (ensemble_of(context.recipe).on()) return depends_of_ensemble(context, ensemble_flags(flags));
  Dependencies depends{{RunPaths(context.out).run}, inputs_of(options_of(context.recipe, context.out), context.out)};
  depends.sealed = {depends.inputs.front()};
  return depends;
}

/// What of the command line a search for the factor of safety does not know.
void refuse_flags_of_runs(const SolveFlags& flags) {
  if (!flags.run.restart && !flags.run.profile) return;
  throw RecipeError({flags.run.restart ? "--restart" : "--profile",
                     "a search for the factor of safety takes no steps in time",
                     "Leave it out; a search that was broken off begins anew"});
}

/// This function runs the members of the recipe's ensemble, and returns the facts for the used recipe.
Facts run_members_of(StageContext& context, const SolveFlags& flags, const std::shared_ptr<const Domain>& domain,
                     const SolveOptions& options, const AnyDevice& device) {
  if (options.stability.factor_of_safety)
    throw RecipeError({"[ensemble] with [solve.stability] factor_of_safety", "the search is no run in time",
                       "Leave one of them out"});
  EnsembleFlags ensemble = ensemble_flags(flags);
  ensemble.on = device.is_gpu() ? On::gpu : On::cpu;
  Facts used = run_ensemble(context, ensemble, domain, options);
  if (!used.empty()) used.emplace_back("on", hardware_of(device));
  return used;
}

/// A context with one queue is made in two thirds of the time of one with eight, and a run uses no more. Members of an
/// ensemble wait for one another less the more there are: 32 are the most. What the environment says counts.
void ask_for_queues(const recipe::Recipe& recipe) {
  ::setenv("CUDA_DEVICE_MAX_CONNECTIONS", ensemble_of(recipe).on() ? "32" : "1", 0);
}

/// This function does what the recipe asks for: an ensemble, a search for the factor of safety, or a run in time. It
/// returns the facts for the used recipe; of a run, `options` then name the stiffness that was settled for its scene.
Facts solved(StageContext& context, const SolveFlags& flags, SolveOptions& options) {
  // The context of a GPU takes longer than all that is read and planned.
  ask_for_queues(context.recipe);
  std::future<AnyDevice> making = std::async(std::launch::async, [&flags] {
    const CrashStack room;
    return make_device(choose_device(flags.on));
  });
  const auto domain_file = inputs_of(options, context.out).front();
  const auto domain = std::make_shared<const Domain>(read_domain(domain_file));
  judge_inputs(context, options, domain_file, *domain);
  for (const std::string& text : idle_places(options, domain->places)) log_info(text);
  options = with_places(std::move(options), domain->places);
  if (ensemble_of(context.recipe).on()) return run_members_of(context, flags, domain, options, making.get());
  if (flags.members || flags.at_a_time > 0)
    throw RecipeError({flags.members ? "--members without an ensemble" : "--at-a-time without an ensemble",
                       "the recipe asks for one run", "Leave it out, or add [ensemble] with members"});
  if (!options.stability.factor_of_safety) {
    const auto made = plan(domain, options);
    for (const std::string& reason : made->reasons) log_info(reason);
    options = noted_options(*made);
    return run_in_time(context, flags.run, made, making.get());
  }
  refuse_flags_of_runs(flags);
  options = with_map_threshold(std::move(options), *domain);
  context.check_only = context.check_only || flags.run.plan;
  return find_stability(context, options, making.get(), *domain);
}

/// This function does what the recipe asks for, and notes what was used.
void solve(StageContext& context, const SolveFlags& flags) {
  SolveOptions options = options_of(context.recipe, context.out);
  const Facts used = solved(context, flags, options);
  if (!used.empty())
    write_used_recipe(context, stage(), recipe::to_used_toml(options, "solve") + used_ensemble(context.recipe, true),
                      inputs_of(options, context.out), used);
}

}  // namespace

Stage stage() {
  const auto given = std::make_shared<SolveFlags>();
  Stage s;
  s.name = "talus-solve";
  s.table = "solve";
  s.summary = "Simulate the slide in three dimensions with the material point method: domain.vdb -> run.h5.";
  s.examples = examples;
  s.template_toml = [] { return recipe::to_toml(SolveOptions{}, "solve", true); };
  s.flags = flags_into(given);
  s.depends = [given](const StageContext& context) { return depends(context, *given); };
  s.used_toml = [](const recipe::Recipe& recipe) {
    return recipe::to_toml(recipe.read<SolveOptions>("solve"), "solve", false) + used_ensemble(recipe, false);
  };
  s.id_of = id_in;
  s.part = [given] { return given->members ? fmt::format("{}-{}", given->members->first, given->members->end) : ""; };
  s.run = [given](StageContext& context) {
    limit_threads_of_libraries(thread_limit());
    solve(context, *given);
  };
  return s;
}

std::future<void> begin_gpu(const recipe::Recipe& recipe) {
  ask_for_queues(recipe);
  return std::async(std::launch::async, [] {
    const CrashStack room;
    static_cast<void>(gpu_available());
  });
}

void end_process(int code) {
  if (!gpu_was_used()) std::exit(code);
  std::fflush(nullptr);
  ::_exit(code);
}

}  // namespace talus::solver
