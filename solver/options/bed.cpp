// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/bed.hpp"

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
  FrictionLaws::each([&](auto own) { own.check(v, *this, shown); });
  v.number("cohesion_Pa", cohesion, recipe::not_negative,
           "traction besides friction, wherever the mass touches its bed");
  v.number("pore_pressure_ratio", pore_pressure_ratio, recipe::Range{0, 1},
           "share of the normal stress on the bed that water carries (saturated ground); friction acts on the rest");
  recipe::choice(v, "separation", separation,
                 {{"free", Separation::free}, {"none", Separation::none}, {"thin", Separation::thin}},
                 "what leaves the bed where that falls away below it: what moves so (free), nothing that lies on it "
                 "(none), what is deeper than separation_depth_m (thin)");
  v.number("separation_depth_m", separation_depth, recipe::not_negative,
           "separation = \"thin\": depth along the normal of the bed below which columns are held; 0: spacing of the "
           "grid");
  v.needs(separation == Separation::thin || !(separation_depth > 0),
          {"[solve.base] separation_depth_m with separation = \"" + separation_name() + "\"",
           "it is the depth up to which \"thin\" holds columns", "Leave it out, or take separation = \"thin\""});
}

double* BaseOptions::named(std::string_view key) {
  NumberFinder finder(key);
  describe(finder);
  return finder.found();
}

bool BaseOptions::uses(std::string_view key) const {
  return visit_law(law, [&](auto own) { return own.uses(key) || (own.rubs && is_common(key)); });
}

std::vector<std::string> BaseOptions::idle() const {
  return idle_keys(*this, [&](std::string_view key) { return uses(key); });
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

std::string BaseOptions::separation_name() const {
  return separation == Separation::free ? "free" : separation == Separation::none ? "none" : "thin";
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
  if (separation == Separation::none) text += ", never left by what lies on it";
  if (separation == Separation::thin)
    text += ", left only by what is deeper than " +
            (separation_depth > 0 ? six_digits(separation_depth) + " m" : std::string("the spacing of the grid"));
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
