// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/bed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// The visitor that finds the number of a key among the options visited.
class NumberFinder final : public recipe::Visitor {
 public:
  explicit NumberFinder(std::string_view key) : key_(key) {}
  double* found() const { return found_; }

  void number(std::string_view key, double& value, recipe::Range, std::string_view) override {
    if (key == key_) found_ = &value;
  }
  std::size_t begin_list(std::string_view, std::size_t, std::string_view) override { return 0; }

 private:
  std::string_view key_;
  double* found_ = nullptr;
};

/// Whether a key acts with every law that rubs.
bool is_common(std::string_view key) { return key == "cohesion_Pa" || key == "pore_pressure_ratio"; }

}  // namespace

void BaseOptions::describe(recipe::Visitor& v) {
  choose_law<FrictionLaws>(v, "law", law, "friction between the mass and its bed");
  const std::string name = law_name();
  const LawTable shown{.name = "[solve.base]", .chosen = name};
  OptionsOfLaws::describe(v, shown);
  for (const auto& [form, given] : forms()) {
    if (!*given || uses(form.key) || !uses(form.of)) continue;
    std::optional<double> number;  // settled options have no form: it is read here alone, beside the form
    v.optional_number(form.of, number, recipe::any, "");
    if (number) given_twice = form.key;
  }
  v.needs(given_twice.empty(), {"[solve.base] " + given_twice + " beside " +
                                    (given_twice.empty() ? "" : std::string(bed_form(given_twice)->of)),
                                "they are one quantity in two forms", "Leave one of them out"});
  FrictionLaws::each([&](auto own) { own.check(v, *this, shown); });
  v.number("cohesion_Pa", cohesion, recipe::not_negative,
           "traction besides friction, wherever the mass touches its bed");
  v.number("pore_pressure_ratio", pore_pressure_ratio, recipe::Range{0, 1},
           "share of the normal stress on the bed that water carries (saturated ground); friction acts on the rest");
}

std::array<GivenForm, bed_forms.size()> BaseOptions::forms() {
  return {{{bed_forms[0], &friction_coefficient},
           {bed_forms[1], &stop_coefficient},
           {bed_forms[2], &steepest_coefficient},
           {bed_forms[3], &start_coefficient},
           {bed_forms[4], &drag_coefficient}}};
}

double* BaseOptions::named(std::string_view key) {
  if (key == bed_forms[0].key) return &friction_coefficient.emplace(mu());
  NumberFinder finder(key);
  describe(finder);
  return finder.found();
}

bool BaseOptions::takes(std::string_view key) const {
  return uses(key) || std::ranges::any_of(bed_forms, [&](const BedForm& form) {
           return (key == form.key && uses(form.of)) || (key == form.of && uses(form.key));
         });
}

void BaseOptions::settle(double gravity) {
  for (const auto& [form, given] : forms()) {
    if (!*given || uses(form.key) || !uses(form.of)) continue;
    *named(form.of) = number_of(form, **given, gravity);
    given_as.emplace_back(form.key);
    given->reset();
  }
}

std::pair<std::string_view, double> BaseOptions::as_given(std::string_view key, double value, double gravity) const {
  for (const BedForm& form : bed_forms)
    if (form.of == key && std::ranges::find(given_as, form.key) != given_as.end())
      return {form.key, form_of(form, value, gravity)};
  return {key, value};
}

double number_of(const BedForm& form, double value, double gravity) {
  return form.key == "drag_coefficient" ? gravity / value : std::atan(value) * 180 / std::numbers::pi;
}

double form_of(const BedForm& form, double number, double gravity) {
  return form.key == "drag_coefficient" ? gravity / number : std::tan(number * (std::numbers::pi / 180));
}

bool BaseOptions::uses(std::string_view key) const {
  return visit_law(law, [&](auto own) { return own.uses(key) || (own.rubs && is_common(key)); });
}

std::vector<std::string> BaseOptions::idle() const {
  std::vector<std::string> idle = idle_keys(*this, [&](std::string_view key) { return uses(key); });
  BaseOptions copy = *this;
  for (const auto& [form, given] : copy.forms())
    if (*given && !takes(form.key)) idle.emplace_back(form.key);
  return idle;
}

bool BaseOptions::asks_column() const {
  return visit_law(law, [](auto own) { return decltype(own)::asks_column; });
}

std::string BaseOptions::law_name() const {
  return visit_law(law, [](auto own) { return std::string(own.name); });
}

std::string BaseOptions::friction_key() const {
  return visit_law(law, [](auto own) { return std::string(own.friction_key); });
}

std::string BaseOptions::words() const {
  std::string text = visit_law(law, [&](auto own) {
    std::string of_law = own.words(*this);
    if (!own.rubs) return of_law;
    if (cohesion > 0) of_law += ", cohesion " + six_digits(cohesion) + " Pa";
    if (pore_pressure_ratio > 0)
      of_law += ", water carries " + six_digits(pore_pressure_ratio) + " of the normal stress";
    return of_law;
  });
  return text;
}

std::string BaseOptions::sentence() const {
  return visit_law(law, [&](auto own) { return own.sentence(*this); });
}

template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options) {
  const BaseOptions& o = options.base;
  const BedSetting setting{
      .borne = 1 - o.pore_pressure_ratio, .density = options.material.density, .gravity = options.gravity_size()};
  BaseFriction<double> f;
  f.law = o.law;
  visit_law(o.law, [&](auto own) {
    own.numbers(o, setting, f.uniform.numbers);
    own.constants(o, setting, f.constants);
    if (own.rubs) f.uniform.cohesion = o.cohesion;
  });
  return f.as<Real>();
}

template BaseFriction<float> make_base_friction(const SolveOptions&);
template BaseFriction<double> make_base_friction(const SolveOptions&);

}  // namespace talus::solver
