// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/slides/run_slides.hpp"

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "postprocess/ensemble/run_ensemble.hpp"
#include "postprocess/slides/write_slides.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

void write_all(StageContext& context, const Stage& stage, const Options& options, const Ensemble& ensemble) {
  const auto write = [&](const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context.results.push_back(context.out / name);
    write_text(context.results.back(), bytes);
  };
  for (const char* older : {"slides.nc", "slides.html"}) remove_for_good(context.out / older);
  const std::optional<Survey> no_survey;
  const MemberRows rows = member_rows(ensemble, options, no_survey);
  write("slides.csv", members_csv(rows, "slide"));
  make_folder(context.out / "slides");
  for (const fs::path& file : write_slide_files(context.out / "slides", ensemble, rows))
    context.results.push_back(file);
  const std::string used = used_recipe(context, stage, recipe::to_used_toml(options, "postprocess"), ensemble.files,
                                       {{"ensemble", ensemble.counts.fingerprint},
                                        {"slides", members_words(ensemble)},
                                        {"CRS", crs_name(ensemble.counts.scene.grid.crs_wkt)}});
  write("postprocess.used.toml", used);
  if (options.writes("report")) {
    const EnsemblePageInput input{ensemble, options, no_survey, rows, {}, texts_of_stages(context, used)};
    write("slides.html", ensemble_html(input, slide_page_parts(input)));
  }
  stop_if_interrupted("writing slides.nc");
  context.results.push_back(context.out / "slides.nc");
  write_slides_netcdf(context.results.back(), ensemble, rows, options, context.command_line);
}

}  // namespace

Dependencies slides_depends(const StageContext& context) {
  return {{context.out / "slides.nc"}, ensemble_files(context.out)};
}

void run_slides(StageContext& context, const Stage& stage, const Options& options) {
  const Ensemble ensemble = read_ensemble(context);
  const MapGrid& grid = ensemble.counts.scene.grid;
  log_info(fmt::format("slides: {}; over {} x {} cells of {:g} m", members_words(ensemble), grid.columns, grid.rows,
                       grid.cell));
  if (!context.check_only) write_all(context, stage, options, ensemble);
}

}  // namespace talus::postprocess
