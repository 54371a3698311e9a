// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/used.hpp"

#include "common/ensemble/options.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

std::string text_of(const SlideOptions& slides, const EnsembleOptions& ensemble, bool marked) {
  const auto used = [&](const auto& of, const char* table) {
    return "\n" + (marked ? recipe::to_used_toml(of, table) : recipe::to_toml(of, table, false));
  };
  return (slides.on() ? used(slides, "slides") : "") + (ensemble.on() ? used(ensemble, "ensemble") : "");
}

}  // namespace

std::string used_ensemble(const recipe::Recipe& recipe, bool marked) {
  return text_of(slides_of(recipe), ensemble_of(recipe), marked);
}

std::string ensemble_mark(const recipe::Recipe& recipe) {
  SlideOptions slides = slides_of(recipe);
  EnsembleOptions ensemble = ensemble_of(recipe);
  const auto by_name = [](std::filesystem::path& file) { file = file.filename(); };
  by_name(slides.outlines);
  for (ScenarioOptions& scenario : slides.scenario) by_name(scenario.outline);
  by_name(ensemble.table);
  for (VaryOptions& vary : ensemble.vary) by_name(vary.table);
  return sha256_of_text(text_of(slides, ensemble, false)).substr(0, mark_digits);
}

}  // namespace talus
