// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slides as members: the recipe of each, and the table of all.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/error.hpp"
#include "common/map/crop.hpp"
#include "common/recipe/values.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/slides/slides.hpp"

namespace talus::preprocess {
namespace {

/// What a slide sets itself, so that its attributes cannot, but for how much is released.
constexpr const char* of_slides[] = {"preprocess.release",         "preprocess.source",    "preprocess.base_dem",
                                     "preprocess.before_dem",      "preprocess.after_dem", "preprocess.sliding_surface",
                                     "preprocess.thickness_factor"};

bool gives(const recipe::Recipe& recipe, const std::string& key) {
  return recipe.canonical("preprocess").value_or("").find("\"" + key + "\":") != std::string::npos;
}

/// The one [[preprocess.release]] of a slide, which sets this amount.
std::string release_of(const std::filesystem::path& source, const char* amount) {
  return fmt::format("preprocess.release=[{{polygons={},{}=1.0}}]", recipe::toml_text(source.string()), amount);
}

std::string source_of(const std::filesystem::path& source) {
  return "preprocess.source.polygon=" + recipe::toml_text(source.string());
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// What a slide's recipe has beyond the one that all share, of [preprocess], but for what its attributes set.
std::vector<std::string> values_of(const Slide& slide, ModelIs model, const MapGrid& window) {
  std::vector<std::string> values;
  if (model == ModelIs::base) {
    std::vector<MapPolygon> turned = slide.outline;
    check_polygons(turned, slide.place);
    values.push_back(release_of(slide.source, slide.sets(volume_key) ? "volume_m3" : "thickness_m"));
  } else {
    values.push_back(source_of(slide.source));
  }
  values.push_back(fmt::format("preprocess.grid.extent_m=[{}, {}, {}, {}]", recipe::toml_number(window.west),
                               recipe::toml_number(window.south), recipe::toml_number(window.east()),
                               recipe::toml_number(window.north())));
  return values;
}

/// A column of a key of the recipe: numbers where all are, else words.
MemberColumn column_of(const std::vector<Slide>& slides, std::size_t place) {
  MemberColumn column{slides.front().set[place].first, {}, {}};
  std::vector<std::string> texts;
  for (const Slide& slide : slides) {
    const auto found =
        std::find_if(slide.set.begin(), slide.set.end(), [&](const auto& one) { return one.first == column.key; });
    texts.push_back(found->second);
  }
  const bool numbers =
      std::all_of(texts.begin(), texts.end(), [](const std::string& text) { return number_in(text).has_value(); });
  for (const std::string& text : texts) {
    if (numbers) {
      column.values.push_back(*number_in(text));
      continue;
    }
    const auto known = std::find(column.words.begin(), column.words.end(), text);
    column.values.push_back(static_cast<double>(known - column.words.begin()));
    if (known == column.words.end()) column.words.push_back(text);
  }
  return column;
}

void refuse_own_keys(const MemberTable& table) {
  for (const MemberColumn& column : table.columns)
    for (const char* own : of_slides)
      if (!is_amount(column.key) && (column.key == own || column.key.starts_with(std::string(own) + ".") ||
                                     column.key.starts_with(std::string(own) + "[")))
        throw RecipeError(Fault{
            "[slides]: " + column.key + " cannot be set by an attribute",
            "what is released, and on which ground, [slides] says itself",
            fmt::format("Set {}, {}, {} or {}, or leave it out", thickness_key, volume_key, cut_keys[0], cut_keys[1])});
}

/// The faults of a slide's recipe, with the slide in the place of the command line's --set.
Options options_of(const recipe::Recipe& recipe, const Slide& slide, const std::vector<std::string>& values) {
  try {
    return recipe.with(values).read<Options>("preprocess");
  } catch (const RecipeError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults) fault.what = fmt::format("{} ({}): {}", slide.place, slide.name, fault.what);
    throw RecipeError(std::move(faults));
  }
}

}  // namespace

ModelIs model_of(const recipe::Recipe& recipe) {
  const bool base = gives(recipe, "base_dem"), before = gives(recipe, "before_dem");
  if (base == before)
    throw RecipeError(Fault{base ? "[slides]: base_dem and before_dem are both given"
                                 : "[slides]: neither base_dem nor before_dem is given in [preprocess]",
                            "all slides lie on one elevation model",
                            "Give base_dem (a mass is laid onto it) or before_dem (it is cut out of it)"});
  for (const char* key : {"release", "polygon", "after_dem", "laboratory", "box", "place", "extent_m"})
    if (gives(recipe, key))
      throw RecipeError(Fault{fmt::format("[preprocess]: {} beside [slides]", key),
                              "[slides] says what fails, and which part of the model each slide gets", "Leave it out"});
  return base ? ModelIs::base : ModelIs::before;
}

Options shared_options(const recipe::Recipe& recipe, const SlideOptions& slides) {
  const std::filesystem::path& some = slides.scenario.empty() ? slides.outlines : slides.scenario.front().outline;
  const bool onto = model_of(recipe) == ModelIs::base;
  return recipe.with({onto ? release_of(some, "thickness_m") : source_of(some)}).read<Options>("preprocess");
}

EnsemblePlan plan_of(const recipe::Recipe& recipe, const std::vector<Slide>& slides, const SlideWindows& windows,
                     ModelIs model) {
  EnsemblePlan plan{.options = ensemble_of(recipe), .table = {}, .ground = {}};
  MemberTable& table = plan.table;
  table.design = design_name(Design::slides);
  table.count = static_cast<std::int64_t>(slides.size());
  table.own_domain.assign(slides.size(), 1);
  table.slides.emplace();
  table.slides->lattice = windows.lattice;
  table.slides->windows = windows.windows;
  table.slides->ground = windows.ground;
  for (std::size_t place = 0; place < slides.front().set.size(); ++place)
    table.columns.push_back(column_of(slides, place));
  refuse_own_keys(table);
  for (std::size_t k = 0; k < slides.size(); ++k) {
    table.names.push_back(slides[k].name);
    std::vector<std::string> values = values_of(slides[k], model, cut(windows.lattice, windows.windows[k]));
    for (std::string& value : table.values_of(static_cast<std::int64_t>(k), "preprocess."))
      values.push_back(std::move(value));
    plan.ground.emplace_back(options_of(recipe, slides[k], values));
    plan.own_values.push_back(std::move(values));
  }
  check_keys(table, *plan.ground.front());
  plan.options.check_kept(table.count);
  return plan;
}

}  // namespace talus::preprocess
