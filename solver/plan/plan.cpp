// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/plan.hpp"

#include <utility>

#include "solver/plan/plausible.hpp"
#include "solver/plan/step_choice.hpp"
#include "solver/plan/stiffness.hpp"
#include "solver/plan/warnings.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

Plan begin_plan(std::shared_ptr<const Domain> domain, const SolveOptions& options) {
  Plan begun{.domain = std::move(domain), .asked = with_preset(options), .options = {}, .scene = {}, .bound = {}};
  begun.options = begun.asked;
  begun.scene = begin_scene(*begun.domain, begun.options);
  begun.bound = speed_bound(*begun.domain, begun.options, begun.scene);
  return begun;
}

void settle(Plan& plan) {
  plan.options = settle_stiffness(std::move(plan.options), plan.bound, plan.reasons);
  plan.options = settle_steps(*plan.domain, std::move(plan.options), plan.bound, plan.reasons);
}

Plan draft_plan(std::shared_ptr<const Domain> domain, const SolveOptions& options, Settle how) {
  Plan draft = begin_plan(std::move(domain), options);
  if (how == Settle::as_asked) settle(draft);
  draft.scene = finish_scene(*draft.domain, draft.options, std::move(draft.scene));
  return draft;
}

std::shared_ptr<const Plan> plan(std::shared_ptr<const Domain> domain, const SolveOptions& options, Settle how) {
  Plan made = draft_plan(std::move(domain), options, how);
  made.accepted = judge_plan(made).facts();
  made.warnings = warnings(made);
  made.advice = advice(made);
  return std::make_shared<const Plan>(std::move(made));
}

SolveOptions noted_options(const Plan& plan) {
  if (!leaves_stiffness(plan.asked)) return plan.asked;
  return with_stiffness(plan.asked, {.modulus = plan.options.material.youngs_modulus, .reason = {}});
}

std::shared_ptr<const Plan> plan(Domain domain, const SolveOptions& options, Settle how) {
  return plan(std::make_shared<const Domain>(std::move(domain)), options, how);
}

}  // namespace talus::solver
