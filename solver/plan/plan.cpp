// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/plan.hpp"

#include <algorithm>
#include <utility>

#include "solver/plan/step_choice.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

Plan begin_plan(std::shared_ptr<const Domain> domain, const SolveOptions& options) {
  Plan begun{.domain = std::move(domain), .asked = with_preset(options), .options = {}, .scene = {}, .bound = {}};
  begun.options = with_map_threshold(begun.asked, *begun.domain);
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
  Findings found("solve", made.options.accept, Findings::Log::kept_back);
  refuse_implausible(made);
  found.settle();
  warn_of_plan(made);
  advise_on_plan(made);
  made.findings = found.list();
  return std::make_shared<const Plan>(std::move(made));
}

std::vector<MapPlace> places_of(const Plan& plan) {
  const SolveOptions& o = plan.options;
  std::vector<MapPlace> places = plan.domain->obstacles;
  std::erase_if(places, [&](const MapPlace& place) {
    return std::ranges::none_of(o.obstacles, [&](const auto& one) { return place.words == "obstacle " + one.name; });
  });
  for (const SectionOptions& s : o.sections) places.push_back({"section " + s.name, {s.line}});
  for (std::size_t n = 0; n < o.inflows.size(); ++n)
    places.push_back({"inflow " + inflow_name(o.inflows[n], n), {o.inflows[n].line}});
  for (const GaugeOptions& g : o.gauges) places.push_back({"gauge " + g.name, {{{g.x, g.y}}}});
  return places;
}

std::vector<Finding> findings_of(const Plan& plan) {
  std::vector<Finding> findings = plan.domain->findings;
  findings.insert(findings.end(), plan.findings.begin(), plan.findings.end());
  return findings;
}

SolveOptions noted_options(const Plan& plan) {
  SolveOptions noted = plan.asked;
  noted.map_threshold = plan.options.map_threshold;
  if (!leaves_stiffness(noted)) return noted;
  return with_stiffness(std::move(noted), {.modulus = plan.options.material.youngs_modulus, .reason = {}});
}

std::shared_ptr<const Plan> plan(Domain domain, const SolveOptions& options, Settle how) {
  return plan(std::make_shared<const Domain>(std::move(domain)), options, how);
}

}  // namespace talus::solver
