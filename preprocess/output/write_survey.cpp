// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/output/write_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/qgis/project.hpp"
#include "common/qgis/style.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/survey/change.hpp"
#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {
namespace fs = std::filesystem;

namespace {

const std::vector<double> change_classes{0.5, 1, 2, 5, 10, 25, 50};
const std::vector<double> thickness_classes{0.1, 0.5, 1, 2, 5, 10, 25, 50, 100};
const std::vector<double> sigma_classes{0.05, 0.1, 0.2, 0.5, 1, 2, 5};

RasterStyle change_style() { return difference_style(change_classes, "m"); }
RasterStyle thickness_style() { return class_style(thickness_classes, "m"); }
RasterStyle sigma_style() { return class_style(sigma_classes, "m"); }

/// What every raster carries: of which domain's preparation it is.
RasterTags tags_of(const std::string& description, const std::string& id, const char* unit) {
  return {description, unit, {{"SOURCE", "Talus " + version()}, {"DOMAIN_ID", id}}};
}
RasterTags tags_of(const std::string& description, const std::string& id) {
  return tags_of(description + " [m]", id, "m");
}

/// The range that makes the mean over a typical slide as uncertain as the variogram does; for the resampling of scores.
double correlation_length(const Survey& survey, const SurveyedSlide* slide) {
  double area = 100 * survey.grid.cell * survey.grid.cell;
  if (slide)
    for (const auto& side : slide->volumes) area = std::max(area, side.volume.area);
  return survey.errors.variogram().equivalent_range(area, survey.grid.cell);
}

void remove_with_style(fs::path file) {
  remove_for_good(file);
  remove_for_good(file.replace_extension(".qml"));
}

/// The rasters over all that both surveys hold, and the volumes, in one walk.
class BlockFiles {
 public:
  BlockFiles(const fs::path& folder, const Survey& survey, double length, const std::string& id)
      : survey_(survey),
        before_(folder / "before_aligned.tif", survey.grid, tags_of("surface before", id)),
        after_(folder / "after_aligned.tif", survey.grid, tags_of("surface after, on the one before", id)),
        difference_(folder / "difference.tif", survey.grid, tags_of("surface after less surface before", id)) {
    const fs::path file = folder / "difference_sigma.tif";
    if (survey.errors.is_known()) {
      sigma_.emplace(file, survey.grid, tags_of("standard error of the difference", id));
      sigma_->set_item("CORRELATION_LENGTH_M", fmt::format("{:.6g}", length));
    } else {
      remove_with_style(file);  // of an earlier recipe, perhaps
    }
    if (survey.applied)
      unaligned_.emplace(folder / "difference_unaligned.tif", survey.grid,
                         tags_of("surface after as it came less surface before", id));
  }

  Budgets walk() {
    BudgetSum raw, believed;
    for_each_block(survey_.before, survey_.after, survey_.grid, survey_.errors, [&](const Block& block) {
      before_.write(block.before);
      after_.write(block.after);
      difference_.write(block.difference);
      if (sigma_) sigma_->write(block.sigma);
      if (unaligned_) unaligned_->write(as_it_came(block));
      for (std::size_t i = 0; i < block.difference.values.size(); ++i) {
        const double d = block.difference.values[i], sigma = block.sigma.values[i];
        if (std::isnan(d)) continue;
        raw.add(d, sigma);
        if (!(std::abs(d) > level_of_detection(sigma))) continue;
        believed.add(d, sigma);
        order_.add(d, block.before.values[i]);
      }
    });
    for (RasterWriter* file : {&before_, &after_, &difference_}) file->finish();
    if (sigma_) sigma_->finish();
    if (unaligned_) unaligned_->finish();
    return {raw.budget(survey_.errors, survey_.grid.cell), believed.budget(survey_.errors, survey_.grid.cell)};
  }

  /// What rose and fell, of believed change; after walk().
  Order order() const { return order_.order(survey_.grid.cell); }

 private:
  Raster as_it_came(const Block& block) const {
    Elevation after = survey_.after;
    after.placement = {};
    Raster difference = onto_grid(after, block.before.grid);
    for (std::size_t i = 0; i < difference.values.size(); ++i) difference.values[i] -= block.before.values[i];
    return difference;
  }

  const Survey& survey_;
  RasterWriter before_, after_, difference_;
  std::optional<RasterWriter> sigma_, unaligned_;
  OrderSum order_;
};

/// 1 where ground counted as stable, 0 where not, nodata where nobody looked.
void write_stable(const fs::path& file, const Survey& survey, const std::string& id) {
  RasterWriter writer(file, survey.grid, tags_of("ground that counted as stable [1]", id, "1"));
  for (const auto& [grid, stable] : survey.stable) {
    const MapGrid part = shared_part(grid, survey.grid);  // the rest of it was shared only before the later model moved
    if (part.count() > 0) writer.write(cut_to({grid, std::vector<double>(stable.begin(), stable.end())}, part));
  }
  writer.finish();
}

std::string words(const VolumeWithError& v) {
  if (std::isnan(v.error)) return fmt::format("{} m3 (error not known)", grouped(v.volume));
  return fmt::format("{} +- {} m3", grouped(v.volume), grouped(v.error));
}

void say_volumes(const Survey& survey, const Budgets& budgets, const SurveyedSlide* slide,
                 std::vector<std::string>& lines) {
  const auto line = [&](const std::string& what, const Budget& b) {
    lines.push_back(fmt::format("{}: erosion {}, deposition {}, net {}", what, words(b.erosion), words(b.deposition),
                                words(b.net)));
  };
  line("difference, all cells", budgets.raw);
  line(fmt::format("difference beyond its level of detection ({:.2f} m at least)",
                   level_of_detection(survey.errors.sigma(0))),
       budgets.thresholded);
  if (!slide) return;
  for (const auto& side : slide->volumes)
    lines.push_back(
        fmt::format("{} as surveyed: {} on {} m2", side.name, words(side.volume), grouped(side.volume.area)));
}

void put(std::vector<fs::path>& files, const fs::path& file, const Raster& raster, RasterTags tags,
         const RasterStyle& style) {
  tags.metadata.emplace_back("THICKNESS_CONVENTION",
                             "vertical, measured along the plumb line (not normal to the slope)");
  write_cog(file, raster, tags);
  write_qgis_style(file, style);
  files.push_back(file);
}

/// Everything at once: outlines over differences over the ground.
void write_project(const fs::path& folder, const Survey& survey, std::vector<fs::path>& files) {
  const auto is_there = [&](const char* name) {
    return std::find(files.begin(), files.end(), folder / name) != files.end();
  };
  QgisProject project{"Surveyed change",
                      survey.grid.crs_wkt,
                      {survey.grid.west, survey.grid.south, survey.grid.east(), survey.grid.north()},
                      {}};
  ProjectGroup change{"Change", {}};
  if (is_there("outlines.gpkg"))
    project.groups.push_back(
        {"Outlines",
         {{"source", "outlines.gpkg|layername=source", true, OutlineStyle{{0.0, 0.45, 0.35}, 0.6, false}},
          {"deposit", "outlines.gpkg|layername=deposit", true, OutlineStyle{{0.05, 0.25, 0.65}, 0.6, true}}}});
  const auto add = [&](const char* name, const char* words, bool shown, const RasterStyle& style) {
    if (is_there(name)) change.layers.push_back({words, name, shown, style});
  };
  add("slide_difference.tif", "difference in the slide", true, change_style());
  add("difference.tif", "difference", !is_there("slide_difference.tif"), change_style());
  add("difference_unaligned.tif", "difference as the models came", false, change_style());
  add("difference_sigma.tif", "standard error of the difference", false, sigma_style());
  add("source_thickness.tif", "source, thickness", false, thickness_style());
  add("deposit_surveyed.tif", "deposit, rise of the surface", false, thickness_style());
  project.groups.push_back(change);
  project.groups.push_back({"Ground",
                            {{"surface after", "after_aligned.tif", false, HillshadeStyle{}},
                             {"surface before", "before_aligned.tif", true, HillshadeStyle{}}}});
  files.push_back(folder / "survey.qgs");
  write_qgis_project(files.back(), project);
}

}  // namespace

std::vector<fs::path> write_source(const fs::path& folder, const Prepared& prepared) {
  make_folder(folder);
  std::vector<fs::path> files;
  const Domain& domain = prepared.domain;
  put(files, folder / "source_thickness.tif", domain.release_thickness,
      tags_of("thickness of the source, vertical", fact(domain.provenance, domain_id)), thickness_style());
  Raster bed = domain.terrain;
  for (std::size_t i = 0; i < bed.values.size(); ++i)
    if (!(domain.release_thickness.values[i] > 0)) bed.values[i] = nan;  // outside the source
  files.push_back(folder / "sliding_surface.tif");
  write_cog(files.back(), bed, tags_of("surface that the source slides on", fact(domain.provenance, domain_id)));
  write_qgis_hillshade_style(files.back());
  std::vector<OutlineLayer> layers{
      {"source", {{"source", outline_above(domain.release_thickness, 0), {{"volume_m3", prepared.total.volume}}}}}};
  if (prepared.slide) {
    const auto& [name, volume] = prepared.slide->volumes.back();
    layers.push_back({name, {{name, outline_above(prepared.slide->deposit, 0), {{"volume_m3", volume.volume}}}}});
    for (std::size_t side = 0; side < layers.size(); ++side) {
      const double error = prepared.slide->volumes.at(side).volume.error;
      if (!std::isnan(error)) layers[side].features.front().numbers.emplace_back("volume_error_m3", error);
    }
  }
  files.push_back(folder / "outlines.gpkg");
  write_outlines(files.back(), domain.grid.crs_wkt, layers);
  return files;
}

std::vector<fs::path> write_survey(const fs::path& folder, const Survey& survey, const Prepared* prepared,
                                   const Facts& marks, std::vector<std::string>& lines) {
  make_folder(folder);
  const SurveyedSlide* slide = prepared && prepared->slide ? &*prepared->slide : nullptr;
  const std::string id = fact(marks, domain_id);
  BlockFiles blocks(folder, survey, correlation_length(survey, slide), id);
  const Budgets budgets = blocks.walk();
  if (const auto wrong = wrong_order(blocks.order(), {survey.before.file.string(), survey.after.file.string()});
      wrong && !prepared)
    warn("swapped-surveys", to_string(*wrong));
  std::vector<fs::path> files;
  const auto add = [&](const char* name) -> const fs::path& { return files.emplace_back(folder / name); };
  for (const char* name : {"before_aligned.tif", "after_aligned.tif"}) write_qgis_hillshade_style(add(name));
  write_qgis_style(add("difference.tif"), change_style());
  if (survey.applied) write_qgis_style(add("difference_unaligned.tif"), change_style());
  if (survey.errors.is_known()) write_qgis_style(add("difference_sigma.tif"), sigma_style());
  if (!survey.stable.empty()) write_stable(add("stable_ground.tif"), survey, id);
  if (slide) {
    for (const auto& file : write_source(folder, *prepared)) files.push_back(file);
    put(files, folder / "deposit_surveyed.tif", slide->deposit,
        tags_of("surveyed rise of the surface in the deposit", id), thickness_style());
    put(files, folder / "slide_difference.tif", slide->change,
        tags_of("surface after less surface before, in the slide alone", id), change_style());
    if (!slide->filled.values.empty())
      write_cog(add("filled.tif"), slide->filled, tags_of("voids filled: 1 before, 2 after, 3 both", id, "1"));
  }
  say_volumes(survey, budgets, slide, lines);
  write_project(folder, survey, files);
  write_text(add("survey.json"), survey_json(survey, budgets, prepared ? prepared->slide : std::nullopt, marks));
  return files;
}

}  // namespace talus::preprocess
