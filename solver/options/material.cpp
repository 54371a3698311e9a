// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/material.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace talus::solver {
bool MaterialOptions::softens() const {
  return with_law([](auto, const auto& options) { return options.softens(); });
}

std::vector<std::string> MaterialOptions::idle() const {
  const auto own = with_law([](auto, const auto& options) { return numbers_of(options, LawTable{}); });
  return idle_keys(*this, [&](std::string_view key) { return own.contains(key); });
}

bool MaterialOptions::dilates() const {
  return with_law([](auto, const auto& options) { return options.dilates(); });
}

double MaterialOptions::internal_friction() const {
  return with_law([](auto, const auto& options) {
    if constexpr (requires { options.internal_friction(); })
      return options.internal_friction();
    else
      return 0.0;
  });
}

bool MaterialOptions::steps_implicitly() const {
  return with_law([](auto law, const auto&) { return law.steps_implicitly; });
}

bool MaterialOptions::stiffness_is_free() const {
  return with_law([](auto law, const auto&) { return law.stiffness_is_free; });
}
bool MaterialOptions::holds_tension() const {
  return with_law([](auto law, const auto& options) {
    if constexpr (requires { options.tension_cutoff; })
      return options.tension_cutoff > 0;
    else
      return !law.stiffness_is_free;
  });
}

std::string MaterialOptions::name() const {
  return with_law([](auto law, const auto&) { return std::string(law.name); });
}

bool MaterialOptions::pressure_follows_volume() const {
  return with_law([](auto law, const auto&) { return law.pressure_follows_volume; });
}

std::string MaterialOptions::words() const {
  const std::string elasticity =
      fmt::format("{:g} kg/m3, {:.3g} Pa, Poisson's ratio {:g}", density, youngs_modulus, poisson_ratio);
  return with_law([&](auto law, const auto& options) { return law.words(options, elasticity); });
}

std::string MaterialOptions::sentence() const {
  return with_law([](auto law, const auto& options) { return law.sentence(options); });
}

void MaterialOptions::describe(recipe::Visitor& v, const std::string& table) {
  choose_law<MaterialLaws>(v, "model", model, "constitutive law");
  v.number("density_kg_m3", density, recipe::positive, "bulk density of the released mass");
  v.number("youngs_modulus_Pa", youngs_modulus, recipe::positive,
           "stiffness; sets the step size, see docs/how-to/steps.md");
  recipe::choice(v, "stiffness", stiffness, {{"as-given", StiffnessKind::as_given}, {"auto", StiffnessKind::automatic}},
                 "auto: the lowest modulus up to that one which leaves the flow unchanged");
  v.number("poisson_ratio", poisson_ratio, recipe::Range{-1, 0.5, true, true}, "Poisson's ratio");
  OptionsOfLaws::describe(v, {.name = table, .chosen = name()});
}

void PartOptions::describe(recipe::Visitor& v) {
  v.text("release", release,
         "name of the release (of talus-preprocess) that is of this material; the keys below have their own defaults");
  const std::string table = fmt::format("[[solve.part]] release = \"{}\"", release);
  material.describe(v, table);
  v.needs(material.stiffness == StiffnessKind::as_given,
          {table + " gives stiffness", "it is the whole scene's", "Give it in [solve.material]"});
}

bool MassOptions::any_material(const std::function<bool(const MaterialOptions&)>& is) const {
  return is(material) || std::ranges::any_of(parts, [&](const PartOptions& part) { return is(part.material); });
}

const MaterialOptions& MassOptions::material_of(const std::string& release) const {
  const auto part = std::ranges::find_if(parts, [&](const PartOptions& p) { return p.release == release; });
  return part == parts.end() ? material : part->material;
}

void MassOptions::describe(recipe::Visitor& v) {
  recipe::list(v, "part", parts, "a release of another material than [solve.material]");
  v.needs(parts.size() < most_materials, {fmt::format("[[solve.part]] is given {} times", parts.size()),
                                          fmt::format("a scene has at most {} materials", most_materials),
                                          "Give releases of the same material the same name, or leave some out"});
  const std::string table = "[solve.material]";
  recipe::table(v, "material", material, "the sliding mass", table);
  v.needs(material.stiffness == StiffnessKind::as_given || material.stiffness_is_free(),
          {table + " stiffness = \"auto\" does not go with this model",
           "what an elastic body does depends on its stiffness",
           "Take model = \"drucker-prager\", or leave stiffness out"});
}

template <class Real>
Material<Real> make_material(const MaterialOptions& o, double side) {
  const double shear = o.youngs_modulus / (2 * (1 + o.poisson_ratio));
  const double bulk = o.youngs_modulus / (3 * (1 - 2 * o.poisson_ratio));
  Material<Real> m;
  m.model = o.model;
  m.density = static_cast<Real>(o.density);
  m.shear_modulus = static_cast<Real>(shear);
  m.bulk_modulus = static_cast<Real>(bulk);
  m.wave_speed = static_cast<Real>(std::sqrt((bulk + 4 * shear / 3) / o.density));
  m.change_law([&](auto law, auto& numbers) {
    using Law = decltype(law);
    numbers = Law::template numbers<Real>(o.options_of<Law>(), side);
  });
  return m;
}

template <class Real>
Materials<Real> make_materials(const MassOptions& options, double spacing, double layer_height) {
  Materials<Real> materials;
  const double side = std::min(spacing, layer_height);
  int next = 0;
  materials.list[next++] = make_material<Real>(options.material, side);
  for (const PartOptions& part : options.parts) materials.list[next++] = make_material<Real>(part.material, side);
  while (next < most_materials) materials.list[next++] = materials.list[0];
  return materials;
}

double fastest_wave(const MassOptions& options) {
  double fastest = make_material<double>(options.material).wave_speed;
  for (const PartOptions& part : options.parts)
    fastest = std::max(fastest, make_material<double>(part.material).wave_speed);
  return fastest;
}

template Material<float> make_material(const MaterialOptions&, double);
template Material<double> make_material(const MaterialOptions&, double);
template Materials<float> make_materials(const MassOptions&, double, double);
template Materials<double> make_materials(const MassOptions&, double, double);

}  // namespace talus::solver
