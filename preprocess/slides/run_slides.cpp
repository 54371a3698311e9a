// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/sum.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/slides/slides.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {
namespace {

namespace fs = std::filesystem;

std::string crs_of_model(const Options& shared) {
  return read_elevation("base_dem", shared.first_dem(), dem_reading(shared.working_crs, shared.vertical_unit))
      .crs_wkt();
}

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

std::vector<fs::path> inputs_of_slides(const recipe::Recipe& recipe) {
  const SlideOptions slides = slides_of(recipe);
  std::vector<fs::path> inputs = inputs_of(shared_options(recipe, slides));
  const auto add = [&](const fs::path& source) {
    const fs::path file = vector_source(source).file;
    if (!file.empty() && std::find(inputs.begin(), inputs.end(), file) == inputs.end()) inputs.push_back(file);
  };
  add(slides.outlines);
  for (const ScenarioOptions& scenario : slides.scenario) add(scenario.outline);
  return inputs;
}

SlidesMade make_slides(StageContext& context) {
  const SlideOptions options = slides_of(context.recipe);
  const ModelIs model = model_of(context.recipe);
  const Options shared = resolved(shared_options(context.recipe, options));
  const std::vector<Slide> slides = list_slides(options, model, crs_of_model(shared));
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
