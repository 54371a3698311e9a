// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/variations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/domain/bed_numbers.hpp"

namespace talus::solver {
namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr double step_factor = 0.5;      // of the row of steps, over the run's
constexpr double modulus_factor = 2;     // of the row of the stiffness, over the run's
constexpr double nearly_one = 1 + 1e-6;  // times the stiffness, in the row of the last digits

/// Numbers of the bed that are friction, as angles or coefficients.
constexpr std::string_view friction_angles[] = {"friction_angle_deg", "stop_angle_deg", "steepest_angle_deg",
                                                "start_angle_deg"};
constexpr std::string_view friction_coefficients[] = {"peak_coefficient",     "steady_coefficient",
                                                      "friction_coefficient", "stop_coefficient",
                                                      "steepest_coefficient", "start_coefficient"};
constexpr std::string_view turbulence = "turbulence_m_s2";

template <std::size_t count>
bool is_among(std::string_view key, const std::string_view (&names)[count]) {
  return std::find(std::begin(names), std::end(names), key) != std::end(names);
}

/// "key=value", the value such that it is read back to the bit.
std::string set_to(const std::string& key, double value) { return fmt::format("{}={}", key, value); }

/// What the program settled for the recipe itself, as keys that say so: "solve.cfl=0.8".
std::vector<std::string> settled_values(const SolveOptions& asked, const SolveOptions& settled) {
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
    values.push_back(set_to("solve.cfl", settled.step_over_cfl()));
  }
  return values;
}

/// The values of a member from the nth on: ": friction_angle_deg = 19.98, turbulence_m_s2 = 500".
std::string changed_words(const Variation& one, std::size_t first) {
  std::string text;
  for (std::size_t n = first; n < one.values.size(); ++n) {
    const std::string& value = one.values[n];
    const std::size_t sign = value.find('='), dot = value.rfind('.', sign);
    text += fmt::format("{} {} = {:.4g}", text.empty() ? ":" : ",", value.substr(dot + 1, sign - dot - 1),
                        std::stod(value.substr(sign + 1)));
  }
  return text + (one.change_bed ? ", and the maps of the bed by as much" : "");
}

/// Friction that is wrong by its doubt, one way.
class OtherFriction {
 public:
  OtherFriction(const BudgetOptions& budget, bool more) : sign_(more ? 1 : -1), share_(budget.friction_doubt) {}

  double angle(double deg) const { return std::atan(coefficient(std::tan(deg * degree))) / degree; }
  double coefficient(double mu) const { return (1 + sign_ * share_) * mu; }
  /// "10 % less".
  std::string words() const { return fmt::format("{:g} % {}", 100 * share_, sign_ > 0 ? "more" : "less"); }

 private:
  double sign_, share_;
};

/// What a recipe with such options would be refused for.
std::vector<std::string> faults_of(SolveOptions options) {
  std::vector<Fault> faults;
  recipe::find_unmet(options, faults);
  std::vector<std::string> words;
  for (const Fault& fault : faults) words.push_back(to_string(fault));
  return words;
}

/// Makes the variations of a scene. Those that change nothing keep their words empty.
class Variations {
 public:
  Variations(const Plan& base, const BudgetOptions& budget, const OptionsWith& options_with)
      : domain_(*base.domain),
        base_(base.options),
        budget_(budget),
        options_with_(options_with),
        settled_(settled_values(base.asked, base.options)),
        known_faults_(faults_of(base.options)) {}

  Variation made(const std::string& name, const std::string& row) const;

 private:
  void change_bed(Variation& one, const BedChange& change) const;
  void own(Variation& one, const std::string& name) const;

  void stiffen(Variation& one, double factor) const;

  void repeat(Variation& one, bool) const;
  void step(Variation& one, bool) const;
  void modulus(Variation& one, bool) const;
  void integrator(Variation& one, bool) const;
  void transfer(Variation& one, bool) const;
  void cells(Variation& one, bool) const;
  void friction(Variation& one, bool more) const;
  void drag(Variation& one, bool more) const;
  void weakening(Variation& one, bool fast) const;
  void strength(Variation& one, bool more) const;
  static constexpr std::pair<std::string_view, void (Variations::*)(Variation&, bool) const> row_makers[] = {
      {"step", &Variations::step},           {"repeat", &Variations::repeat},
      {"modulus", &Variations::modulus},     {"integrator", &Variations::integrator},
      {"transfer", &Variations::transfer},   {"cells", &Variations::cells},
      {"friction", &Variations::friction},   {"drag", &Variations::drag},
      {"weakening", &Variations::weakening}, {"strength", &Variations::strength}};

  const Domain& domain_;
  const SolveOptions& base_;
  const BudgetOptions& budget_;
  const OptionsWith& options_with_;
  std::vector<std::string> settled_;
  std::vector<std::string> known_faults_;  ///< of the run itself: what the program settles need not be what recipes say
};

Variation Variations::made(const std::string& name, const std::string& row) const {
  Variation one{.options = base_, .values = settled_};
  if (row.empty()) one.words = "the recipe as it is";
  if (row == survey_row)
    one.words = fmt::format("elevation models with another error, draw {}", name.substr(row.size() + 1));
  if (row.starts_with("own")) own(one, name);
  const BudgetRow* const of = find_budget_row(row);
  for (const auto& [known, change] : row_makers)
    if (row == known) (this->*change)(one, !of->other.empty() && name.ends_with(of->other));
  if (one.words.empty()) one.left_out = "";
  if (row.starts_with("own")) return one;  // the recipe was read with its values
  for (const std::string& fault : faults_of(one.options))
    if (!one.left_out && std::find(known_faults_.begin(), known_faults_.end(), fault) == known_faults_.end())
      one.left_out = fault;
  return one;
}

void Variations::own(Variation& one, const std::string& name) const {
  const auto change = std::find_if(budget_.changes.begin(), budget_.changes.end(),
                                   [&](const OwnChange& known) { return known.name == name; });
  one.words = fmt::format("{}", fmt::join(change->set, ", "));
  one.values.insert(one.values.end(), change->set.begin(), change->set.end());
  const std::string shown = fmt::format("[[ensemble.budget.run]] \"{}\"", name);
  for (const std::string& value : change->set)
    if (!value.starts_with("solve."))
      throw RecipeError({fmt::format("{} sets {}", shown, value), "the members of a budget differ in [solve]",
                         "Write it so: solve.base.friction_angle_deg=20"});
  try {
    one.options = options_with_(change->set);
  } catch (const RecipeError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults) {
      if (fault.what.starts_with(recipe::set_mark)) fault.what.erase(0, recipe::set_mark.size());
      fault.what = fmt::format("{}: {}", shown, fault.what);
    }
    throw RecipeError(std::move(faults));
  }
}

void Variations::step(Variation& one, bool) const {
  const StepAbilities able = abilities_of(base_.integrator);
  if (able.obey_cfl) {
    one.options.cfl = step_factor * base_.step_over_cfl();
    one.options.largest_step *= step_factor;
    one.values.push_back(set_to("solve.cfl", *one.options.cfl));
    one.values.push_back(set_to("solve.largest_step_s", one.options.largest_step));
  }
  if (able.solve_systems) {
    one.options.implicit.step *= step_factor;
    one.values.push_back(set_to("solve.implicit.step_s", one.options.implicit.step));
  }
  one.words = fmt::format("steps {:g} times as long", step_factor);
}

/// Young's modulus times a factor, of all materials whose stiffness moves the flow by little.
void Variations::stiffen(Variation& one, double factor) const {
  const auto stiffen = [&](MaterialOptions& material, const std::string& table) {
    material.youngs_modulus *= factor;
    one.values.push_back(set_to(table + ".youngs_modulus_Pa", material.youngs_modulus));
  };
  stiffen(one.options.material, "solve.material");
  for (std::size_t n = 0; n < one.options.parts.size(); ++n)
    if (one.options.parts[n].material.stiffness_is_free())
      stiffen(one.options.parts[n].material, fmt::format("solve.part[{}].material", n));
}

/// A run of which no number differs by more than a measurement could tell: what it moves, no single run knows.
void Variations::repeat(Variation& one, bool) const {
  stiffen(one, nearly_one);
  one.words = fmt::format("Young's modulus higher by {:.1g} of it, which changes the last digits", nearly_one - 1);
}

void Variations::modulus(Variation& one, bool) const {
  if (!base_.material.stiffness_is_free()) return;
  stiffen(one, modulus_factor);
  one.words = fmt::format("Young's modulus of {:.3g} Pa instead of {:.3g} Pa", one.options.material.youngs_modulus,
                          base_.material.youngs_modulus);
}

void Variations::integrator(Variation& one, bool) const {
  const bool is_explicit = base_.flow_integrator() == Integrator::explicit_;
  if (!is_explicit && base_.flow_integrator() != Integrator::column_implicit) return;
  const Integrator other = is_explicit ? Integrator::column_implicit : Integrator::explicit_;
  (base_.integrator == Integrator::automatic ? one.options.flow : one.options.integrator) = other;
  one.options.cfl = std::min(base_.step_over_cfl(), default_cfl);  // longer explicit ones need not be stable
  one.values.emplace_back(is_explicit ? "solve.integrator=column-implicit" : "solve.integrator=explicit");
  one.values.push_back(set_to("solve.cfl", *one.options.cfl));
  one.words = is_explicit ? "inertia implicit along columns instead of explicit steps"
                          : "explicit steps instead of inertia implicit along columns";
}

void Variations::transfer(Variation& one, bool) const {
  if (!abilities_of(base_.integrator).obey_cfl) return;
  const bool apic = base_.transfer == Transfer::apic;
  one.options.transfer = apic ? Transfer::flip : Transfer::apic;
  one.values.emplace_back(apic ? "solve.transfer=flip" : "solve.transfer=apic");
  one.words = apic ? "velocity passes by flip instead of apic" : "velocity passes by apic instead of flip";
}

void Variations::cells(Variation& one, bool) const {
  one.words =
      fmt::format("cells of {:g} m instead of {:g} m", budget_.cell_factor * domain_.grid.cell, domain_.grid.cell);
}

void Variations::change_bed(Variation& one, const BedChange& change) const {
  for (const std::string_view key : bed_numbers) {
    if (!base_.base.uses(key)) continue;
    double& value = *one.options.base.named(key);
    const double changed = change(key, value);
    if (changed == value) continue;
    value = changed;
    const auto [as, given] = base_.base.as_given(key, changed, base_.gravity_size());
    one.values.push_back(set_to(fmt::format("solve.base.{}", as), given));
  }
  if (!domain_.bed.empty()) one.change_bed = change;
}

void Variations::friction(Variation& one, bool more) const {
  const OtherFriction other(budget_, more);
  const std::size_t before = one.values.size();
  change_bed(one, [other](std::string_view key, double value) {
    if (is_among(key, friction_angles)) return other.angle(value);
    return is_among(key, friction_coefficients) ? other.coefficient(value) : value;
  });
  if (one.values.size() == before) return;
  one.words = other.words() + changed_words(one, before);
}

void Variations::drag(Variation& one, bool more) const {
  if (!base_.base.uses(turbulence)) return;
  const double factor = 1 + (more ? 1 : -1) * budget_.drag_doubt;
  change_bed(one, [factor](std::string_view key, double value) {
    return key == turbulence ? value / factor : key == "drag_coefficient" ? value * factor : value;
  });
  one.words =
      fmt::format("{:g} % {}", 100 * budget_.drag_doubt, more ? "more" : "less") + changed_words(one, settled_.size());
}

/// The law without its weakening: with the friction at rest, or of fast slip, at any speed.
void Variations::weakening(Variation& one, bool fast) const {
  if (base_.base.law != FrictionLaw::velocity_weakening) return;
  const double mu = fast ? base_.base.steady_coefficient : base_.base.peak_coefficient;
  one.options.base.steady_coefficient = one.options.base.peak_coefficient = mu;
  one.values.push_back(fast ? set_to("solve.base.peak_coefficient", mu) : set_to("solve.base.steady_coefficient", mu));
  for (const auto& [name, raster] : domain_.bed)
    if (name == "peak_coefficient" || name == "steady_coefficient")
      one.left_out = "the friction of the bed is a map, and this row is made of one number";
  one.words = fmt::format("the friction {}, {:g}, at any speed", fast ? "of fast slip" : "at rest", mu);
}

void Variations::strength(Variation& one, bool more) const {
  const OtherFriction other(budget_, more);
  const std::size_t before = one.values.size();
  const auto change = [&](MaterialOptions& material, const std::string& table) {
    const auto turn = [&](double& angle, const char* key) {
      if (!(angle > 0)) return;
      angle = other.angle(angle);
      one.values.push_back(set_to(table + "." + key, angle));
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
  if (one.values.size() == before) return;
  one.words = other.words() + changed_words(one, before);
}

}  // namespace

std::vector<Variation> variations_of(const MemberTable& table, const Plan& base, const BudgetOptions& budget,
                                     const OptionsWith& options_with) {
  const Variations variations(base, budget, options_with);
  std::vector<Variation> list;
  for (std::size_t k = 0; k < table.rows.size(); ++k) list.push_back(variations.made(table.names.at(k), table.rows[k]));
  return list;
}

Domain with_bed(Domain domain, const BedChange& change) {
  for (auto& [name, raster] : domain.bed)
    for (double& value : raster.values)
      if (std::isfinite(value)) value = change(name, value);
  return domain;
}

}  // namespace talus::solver
