// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slides as members: the recipe of each, the table of all, and their domains.
#include <algorithm>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/recipe/recipe.hpp"
#include "common/table_words.hpp"
#include "preprocess/ensemble/csv.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/slides/slides.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {
namespace {

/// What a slide sets itself, so that its attributes cannot, but for how much is released.
constexpr const char* of_slides[] = {"preprocess.release",         "preprocess.source",    "preprocess.base_dem",
                                     "preprocess.before_dem",      "preprocess.after_dem", "preprocess.sliding_surface",
                                     "preprocess.thickness_factor"};

/// The value that begins at `at` in the canonical text of a table.
std::string_view value_at(std::string_view text, std::size_t at) {
  int depth = 0;
  bool quoted = false;
  std::size_t end = at;
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (c == '\\' && quoted) ++end;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (depth == 0 && (c == ',' || c == '}' || c == ']')) break;
    depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
  }
  return text.substr(at, std::min(end, text.size()) - at);
}

/// The values that [preprocess] has under a key, in whichever of its tables.
std::vector<std::string> values_under(const recipe::Recipe& recipe, const std::string& key) {
  const std::string text = recipe.canonical("preprocess").value_or(""), mark = "\"" + key + "\":";
  std::vector<std::string> values;
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1))
    values.emplace_back(value_at(text, at + mark.size()));
  return values;
}

/// Whether a recipe gives a key another value than its default, which a used recipe writes down.
bool gives(const recipe::Recipe& recipe, const std::string& key) {
  const auto usual = values_under(recipe::Recipe::parse(recipe::to_toml(Options{}, "preprocess", false)), key);
  return std::ranges::any_of(values_under(recipe, key),
                             [&](const std::string& value) { return std::ranges::find(usual, value) == usual.end(); });
}

/// The one [[preprocess.release]] of a slide, which sets this amount.
std::string release_of(const std::filesystem::path& source, const char* amount) {
  return fmt::format("preprocess.release=[{{polygons={},{}=1.0}}]", recipe::toml_text(source.string()), amount);
}

std::string source_of(const std::filesystem::path& source) {
  return "preprocess.source.polygon=" + recipe::toml_text(source.string());
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

MemberColumn column_at(const std::vector<Slide>& slides, std::size_t place) {
  const std::string& key = slides.front().set[place].first;
  std::vector<std::string> texts;
  for (const Slide& slide : slides)
    texts.push_back(std::ranges::find_if(slide.set, [&](const auto& one) { return one.first == key; })->second);
  return column_of(key, texts, finite_number);
}

void refuse_own_keys(const MemberTable& table) {
  for (const MemberColumn& column : table.columns)
    for (const char* own : of_slides)
      if (!is_amount(column.key) && is_below(column.key, own))
        throw RecipeError({"[slides]: " + column.key + " cannot be set by an attribute",
                           "what is released, and on which ground, [slides] says itself",
                           fmt::format("Set {}, {}, {} or {}, or leave it out", thickness_key, volume_key, cut_keys[0],
                                       cut_keys[1])});
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

namespace fs = std::filesystem;

void say_plan(const EnsemblePlan& plan, const SlideOptions& options) {
  const SlideTable& slides = *plan.table.slides;
  const MapGrid& grid = slides.lattice;
  Sum cells;
  double largest = 0;
  for (const CellWindow& w : slides.windows) {
    cells.add(static_cast<double>(w.columns) * w.rows);
    largest = std::max(largest, static_cast<double>(w.columns) * w.rows);
  }
  log_info(fmt::format("slides: {} over {} x {} cells of {:g} m, {}", plan.table.count, grid.columns, grid.rows,
                       grid.cell, crs_name(grid.crs_wkt)));
  log_info(fmt::format("  their domains: {} cells in the mean, {} at most ({})",
                       grouped(cells.value() / static_cast<double>(slides.windows.size())), grouped(largest),
                       options.margin ? fmt::format("the outlines and {:g} m around", *options.margin)
                                      : fmt::format("below a line at {:g} degrees", options.reach_angle)));
  for (const MemberColumn& column : plan.table.columns) {
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    log_info(column.words.empty() ? fmt::format("  {}: {:.6g} to {:.6g}", column.key, *low, *high)
                                  : fmt::format("  {}: {} words", column.key, column.words.size()));
  }
}

}  // namespace

ModelIs model_of(const recipe::Recipe& recipe) {
  const bool base = gives(recipe, "base_dem"), before = gives(recipe, "before_dem");
  if (base == before)
    throw RecipeError({base ? "[slides]: base_dem and before_dem are both given"
                            : "[slides]: neither base_dem nor before_dem is given in [preprocess]",
                       "all slides lie on one elevation model",
                       "Give base_dem (a mass is laid onto it) or before_dem (it is cut out of it)"});
  for (const char* key : {"release", "polygon", "after_dem", "laboratory", "box", "place", "extent_m"})
    if (gives(recipe, key))
      throw RecipeError({fmt::format("[preprocess]: {} beside [slides]", key),
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
    table.columns.push_back(column_at(slides, place));
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

std::vector<fs::path> inputs_of_slides(const recipe::Recipe& recipe) {
  const SlideOptions slides = slides_of(recipe);
  std::vector<fs::path> inputs = inputs_of(shared_options(recipe, slides));
  add_input(inputs, slides.outlines);
  for (const ScenarioOptions& scenario : slides.scenario) add_input(inputs, scenario.outline);
  return inputs;
}

SlidesMade make_slides(StageContext& context) {
  const SlideOptions options = slides_of(context.recipe);
  const ModelIs model = model_of(context.recipe);
  const Options shared = resolved(shared_options(context.recipe, options));
  const std::vector<Slide> slides = list_slides(options, model, open_model(shared).crs_wkt());
  EnsemblePlan plan = plan_of(context.recipe, slides, windows_of(slides, options, shared), model);
  say_plan(plan, options);
  const std::vector<fs::path> inputs = inputs_of_slides(context.recipe);
  if (context.check_only) return {inputs, {}, {}};
  SurveyMemory memory;
  const EnsembleBase base{shared, {}, memory, checksums_of(inputs), {}, {}, {}};
  const EnsemblePaths paths{context.out};
  remove_for_good(context.out / "domain.vdb");
  const std::int64_t largest = write_ensemble(context, plan, base);
  const std::string& id = plan.table.slides->domains[static_cast<std::size_t>(largest)];
  return {inputs, {{"id", id}, {"slides", std::to_string(plan.table.count)}}, paths.domain(largest)};
}

void copy_largest(StageContext& context, const SlidesMade& made) {
  const fs::path to = context.out / "domain.vdb";
  PendingFile pending(to);
  std::error_code failed;
  fs::copy_file(made.largest, pending.path(), fs::copy_options::overwrite_existing, failed);
  if (failed)
    throw DataError({fmt::format("{}: cannot be copied to {}", made.largest.string(), to.string()), failed.message(),
                     "Make room, or write elsewhere with --out"});
  pending.commit();
  context.results.push_back(to);
}

}  // namespace talus::preprocess
