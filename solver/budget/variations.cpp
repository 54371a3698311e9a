// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/variations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/domain/bed_numbers.hpp"

namespace talus::solver {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Numbers of the bed that are friction, as angles or coefficients.
constexpr std::string_view friction_angles[] = {"friction_angle_deg", "stop_angle_deg", "steepest_angle_deg",
                                                "start_angle_deg"};
constexpr std::string_view friction_coefficients[] = {"peak_coefficient", "steady_coefficient", "friction_coefficient"};
constexpr std::string_view turbulence = "turbulence_m_s2";

template <std::size_t count>
bool is_among(std::string_view key, const std::string_view (&names)[count]) {
  return std::find(std::begin(names), std::end(names), key) != std::end(names);
}

/// "key=value", the value such that it is read back to the bit.
std::string set_to(const std::string& key, double value) { return fmt::format("{}={}", key, value); }

/// The values of a run from the nth on: ": friction_angle_deg = 19.98, turbulence_m_s2 = 500".
std::string changed_words(const Variation& one, std::size_t first) {
  std::string text;
  for (std::size_t n = first; n < one.run.values.size(); ++n) {
    const std::string& value = one.run.values[n];
    const std::size_t sign = value.find('='), dot = value.rfind('.', sign);
    text += fmt::format("{} {} = {:.4g}", text.empty() ? ":" : ",", value.substr(dot + 1, sign - dot - 1),
                        std::stod(value.substr(sign + 1)));
  }
  return text + (one.change_bed ? ", and the maps of the bed by as much" : "");
}

/// Friction that is wrong by its doubt, one way.
class OtherFriction {
 public:
  OtherFriction(const BudgetOptions& budget, bool more)
      : sign_(more ? 1 : -1), share_(budget.friction_doubt), degrees_(budget.friction_doubt_deg) {}

  double angle(double deg) const {
    if (degrees_) return std::max(0.0, deg + sign_ * *degrees_);
    return std::atan((1 + sign_ * share_) * std::tan(deg * degree)) / degree;
  }
  double coefficient(double mu) const {
    if (!degrees_) return (1 + sign_ * share_) * mu;
    return std::tan(angle(std::atan(mu) / degree) * degree);
  }
  /// "10 % less", "2 deg more".
  std::string words() const {
    const std::string size = degrees_ ? fmt::format("{:g} deg", *degrees_) : fmt::format("{:g} %", 100 * share_);
    return size + (sign_ > 0 ? " more" : " less");
  }

 private:
  double sign_, share_;
  std::optional<double> degrees_;
};

/// Collects the variations of a scene.
class Variations {
 public:
  Variations(const Domain& domain, const BudgetBase& base, const BudgetOptions& budget)
      : domain_(domain),
        base_(base.settled),
        budget_(budget),
        settled_(settled_values(base)),
        known_faults_(faults_of(base.settled)) {}

  std::vector<Variation> all() {
    step();
    modulus();
    integrator();
    transfer();
    cells();
    for (const bool more : {false, true}) friction(more);
    for (const bool more : {false, true}) drag(more);
    for (const bool fast : {false, true}) weakening(fast);
    for (const bool more : {false, true}) strength(more);
    survey();
    return std::move(list_);
  }

 private:
  /// What a recipe with such options would be refused for.
  static std::vector<std::string> faults_of(SolveOptions options);
  /// The variation of a row, as the run itself is until something is changed.
  Variation fresh(const std::string& row, const std::string& name) const {
    return {.run = {.name = name, .row = row, .words = {}, .values = settled_}, .options = base_};
  }
  void add(Variation&& one, std::string words);
  void change_bed(Variation& one, const BedChange& change) const;

  void step();
  void modulus();
  void integrator();
  void transfer();
  void cells();
  void friction(bool more);
  void drag(bool more);
  void weakening(bool fast);
  void strength(bool more);
  void survey();

  const Domain& domain_;
  const SolveOptions& base_;
  const BudgetOptions& budget_;
  std::vector<std::string> settled_;
  std::vector<std::string> known_faults_;  ///< of the run itself: what the program settles need not be what recipes say
  std::vector<Variation> list_;
};

void Variations::add(Variation&& one, std::string words) {
  one.run.words = std::move(words);
  for (const std::string& fault : faults_of(one.options)) {
    if (std::find(known_faults_.begin(), known_faults_.end(), fault) != known_faults_.end()) continue;
    one.run.state = BudgetState::left_out;
    one.run.reason = fault;
    break;
  }
  list_.push_back(std::move(one));
}

std::vector<std::string> Variations::faults_of(SolveOptions options) {
  std::vector<Fault> faults;
  recipe::find_unmet(options, faults);
  std::vector<std::string> words;
  for (const Fault& fault : faults) words.push_back(to_string(fault));
  return words;
}

void Variations::step() {
  if (!budget_.has("step")) return;
  Variation one = fresh("step", "step");
  const StepAbilities able = abilities_of(base_.integrator);
  if (able.obey_cfl) {
    one.options.cfl *= budget_.step_factor;
    one.options.largest_step *= budget_.step_factor;
    one.run.values.push_back(set_to("solve.cfl", one.options.cfl));
    one.run.values.push_back(set_to("solve.largest_step_s", one.options.largest_step));
  }
  if (able.solve_systems) {
    one.options.implicit.step *= budget_.step_factor;
    one.run.values.push_back(set_to("solve.implicit.step_s", one.options.implicit.step));
  }
  add(std::move(one), fmt::format("steps {:g} times as long", budget_.step_factor));
}

void Variations::modulus() {
  if (!budget_.has("modulus") || !base_.material.stiffness_is_free()) return;
  Variation one = fresh("modulus", "modulus");
  const auto stiffen = [&](MaterialOptions& material, const std::string& table) {
    material.youngs_modulus *= budget_.modulus_factor;
    one.run.values.push_back(set_to(table + ".youngs_modulus_Pa", material.youngs_modulus));
  };
  stiffen(one.options.material, "solve.material");
  for (std::size_t n = 0; n < one.options.parts.size(); ++n)
    if (one.options.parts[n].material.stiffness_is_free())
      stiffen(one.options.parts[n].material, fmt::format("solve.part[{}].material", n));
  const double modulus = one.options.material.youngs_modulus;
  add(std::move(one),
      fmt::format("Young's modulus of {:.3g} Pa instead of {:.3g} Pa", modulus, base_.material.youngs_modulus));
}

void Variations::integrator() {
  const bool is_explicit = base_.flow_integrator() == Integrator::explicit_;
  if (!budget_.has("integrator") || (!is_explicit && base_.flow_integrator() != Integrator::column_implicit)) return;
  Variation one = fresh("integrator", "integrator");
  const Integrator other = is_explicit ? Integrator::column_implicit : Integrator::explicit_;
  (base_.integrator == Integrator::automatic ? one.options.flow : one.options.integrator) = other;
  if (!is_explicit) {
    one.options.cfl = std::min(base_.cfl, default_cfl);  // longer ones need not be stable
  }
  one.run.values.emplace_back(is_explicit ? "solve.integrator=column-implicit" : "solve.integrator=explicit");
  one.run.values.push_back(set_to("solve.cfl", one.options.cfl));
  add(std::move(one), is_explicit ? "inertia implicit along columns instead of explicit steps"
                                  : "explicit steps instead of inertia implicit along columns");
}

void Variations::transfer() {
  if (!budget_.has("transfer") || !abilities_of(base_.integrator).obey_cfl) return;
  Variation one = fresh("transfer", "transfer");
  const bool apic = base_.transfer == Transfer::apic;
  one.options.transfer = apic ? Transfer::flip : Transfer::apic;
  one.run.values.emplace_back(apic ? "solve.transfer=flip" : "solve.transfer=apic");
  add(std::move(one), apic ? "velocity passes by flip instead of apic" : "velocity passes by apic instead of flip");
}

void Variations::cells() {
  if (!budget_.has("cells")) return;
  Variation one = fresh("cells", "cells");
  one.run.domain = "cells";
  add(std::move(one),
      fmt::format("cells of {:g} m instead of {:g} m", budget_.cell_factor * domain_.grid.cell, domain_.grid.cell));
}

void Variations::change_bed(Variation& one, const BedChange& change) const {
  for (const std::string_view key : bed_numbers) {
    if (!base_.base.uses(key)) continue;
    double& value = *one.options.base.named(key);
    const double changed = change(key, value);
    if (changed == value) continue;
    value = changed;
    one.run.values.push_back(set_to(fmt::format("solve.base.{}", key), changed));
  }
  if (!domain_.bed.empty()) one.change_bed = change;
}

void Variations::friction(bool more) {
  const OtherFriction other(budget_, more);
  Variation one = fresh("friction", more ? "friction-more" : "friction-less");
  const std::size_t before = one.run.values.size();
  change_bed(one, [other](std::string_view key, double value) {
    if (is_among(key, friction_angles)) return other.angle(value);
    return is_among(key, friction_coefficients) ? other.coefficient(value) : value;
  });
  if (!budget_.has("friction") || one.run.values.size() == before) return;
  const std::string words = other.words() + changed_words(one, before);
  add(std::move(one), words);
}

void Variations::drag(bool more) {
  if (!budget_.has("drag") || !base_.base.uses(turbulence)) return;
  Variation one = fresh("drag", more ? "drag-more" : "drag-less");
  const double factor = 1 + (more ? 1 : -1) * budget_.drag_doubt;
  change_bed(one, [factor](std::string_view key, double value) { return key == turbulence ? value / factor : value; });
  const std::string words = fmt::format("{:g} % {}", 100 * budget_.drag_doubt, more ? "more" : "less");
  add(std::move(one), words + changed_words(one, settled_.size()));
}

/// The law without its weakening: with the friction at rest, or of fast slip, at any speed.
void Variations::weakening(bool fast) {
  if (!budget_.has("weakening") || base_.base.law != FrictionLaw::velocity_weakening) return;
  Variation one = fresh("weakening", fast ? "weakening-fast" : "weakening-rest");
  const double mu = fast ? base_.base.steady_coefficient : base_.base.peak_coefficient;
  one.options.base.steady_coefficient = one.options.base.peak_coefficient = mu;
  one.run.values.push_back(fast ? set_to("solve.base.peak_coefficient", mu)
                                : set_to("solve.base.steady_coefficient", mu));
  for (const auto& [name, raster] : domain_.bed)
    if (name == "peak_coefficient" || name == "steady_coefficient") {
      one.run.state = BudgetState::left_out;
      one.run.reason = "the friction of the bed is a map, and this row is made of one number";
    }
  add(std::move(one), fmt::format("the friction {}, {:g}, at any speed", fast ? "of fast slip" : "at rest", mu));
}

void Variations::strength(bool more) {
  if (!budget_.has("strength")) return;
  const OtherFriction other(budget_, more);
  Variation one = fresh("strength", more ? "strength-more" : "strength-less");
  const std::size_t before = one.run.values.size();
  const auto change = [&](MaterialOptions& material, const std::string& table) {
    const auto turn = [&](double& angle, const char* key) {
      if (!(angle > 0)) return;
      angle = other.angle(angle);
      one.run.values.push_back(set_to(table + "." + key, angle));
    };
    if (material.model == MaterialModel::drucker_prager) {
      turn(material.friction_angle, "friction_angle_deg");
      if (material.softens()) turn(material.residual_friction_angle, "residual_friction_angle_deg");
    } else if (material.model == MaterialModel::mu_of_i) {
      turn(material.static_friction_angle, "static_friction_angle_deg");
      turn(material.limiting_friction_angle, "limiting_friction_angle_deg");
    }
  };
  change(one.options.material, "solve.material");
  for (std::size_t n = 0; n < one.options.parts.size(); ++n)
    change(one.options.parts[n].material, fmt::format("solve.part[{}].material", n));
  if (one.run.values.size() == before) return;
  const std::string words = other.words() + changed_words(one, before);
  add(std::move(one), words);
}

void Variations::survey() {
  if (!budget_.has("survey")) return;
  for (int draw = 1; draw <= budget_.survey_draws; ++draw) {
    Variation one = fresh("survey", survey_draw_name(draw));
    one.run.domain = one.run.name;
    add(std::move(one), fmt::format("elevation models with another error, draw {}", draw));
  }
}

}  // namespace

std::vector<std::string> settled_values(const BudgetBase& base) {
  const SolveOptions &asked = base.asked, &settled = base.settled;
  std::vector<std::string> values;
  if (asked.material.youngs_modulus != settled.material.youngs_modulus ||
      asked.material.stiffness == StiffnessKind::automatic) {
    values.emplace_back("solve.material.stiffness=as-given");
    values.push_back(set_to("solve.material.youngs_modulus_Pa", settled.material.youngs_modulus));
    for (std::size_t n = 0; n < settled.parts.size(); ++n)
      values.push_back(set_to(fmt::format("solve.part[{}].material.youngs_modulus_Pa", n),
                              settled.parts[n].material.youngs_modulus));
  }
  if (asked.integrator == Integrator::automatic && settled.integrator != Integrator::automatic) {
    values.push_back(std::string("solve.integrator=") +
                     (settled.integrator == Integrator::explicit_ ? "explicit" : "column-implicit"));
    values.push_back(set_to("solve.cfl", settled.cfl));
  }
  return values;
}

std::vector<Variation> variations_of(const Domain& domain, const BudgetBase& base, const BudgetOptions& budget) {
  return Variations(domain, base, budget).all();
}

Domain with_bed(Domain domain, const BedChange& change) {
  for (auto& [name, raster] : domain.bed)
    for (double& value : raster.values)
      if (std::isfinite(value)) value = change(name, value);
  return domain;
}

}  // namespace talus::solver
