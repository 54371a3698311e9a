// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/elevation_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"

namespace talus::preprocess {
namespace {

[[noreturn]] void refuse_errors(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError({"[ensemble.elevation_error] " + what, why, mend});
}

/// A seed for each member and part: numbers of the generator SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t seed_of_field(std::uint64_t seed, std::int64_t member, std::size_t part) {
  std::uint64_t z = seed;
  for (const std::uint64_t salt : {static_cast<std::uint64_t>(member), static_cast<std::uint64_t>(part)}) {
    z += 0x9e3779b97f4a7c15u * (salt + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return z;
}

double deviation_at(const std::vector<double>& deviations, std::size_t cell) {
  return deviations.size() == 1 ? deviations[0] : deviations[cell];
}

/// What is left of a variance of one in the mean over a cell of the working grid.
double left_in_a_cell(const Variogram& part, double cell, double of_survey) {
  return cell > of_survey ? std::min(1.0, part.of_mean(cell * cell, of_survey)) : 1.0;
}

double middle_of(std::vector<double> deviations) {
  std::erase_if(deviations, [](double d) { return std::isnan(d); });
  if (deviations.empty()) return 0;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle;
}

}  // namespace

ElevationErrors::ElevationErrors(const ElevationErrorOptions& options, const Options& of_base, const SceneRasters& base,
                                 int seed)
    : seed_(static_cast<std::uint64_t>(seed)) {
  if (options.from_survey) {
    take_survey(base);
    return;
  }
  if (options.thickness_deviation && of_base.way() == Way::laboratory)
    refuse_errors("thickness_deviation_m with a laboratory", "its boxes are not read from maps",
                  "Leave it out, or vary the boxes");
  if (options.terrain_deviation) terrain_ = {*options.terrain_deviation};
  if (options.thickness_deviation) thickness_ = {*options.thickness_deviation};
  add_part(base.bed.grid, 1, *options.range);
}

void ElevationErrors::take_survey(const SceneRasters& base) {
  if (!base.survey)
    refuse_errors("from_survey = true without two surveys", "the recipe gives no before_dem and after_dem to compare",
                  "Give the numbers: terrain_deviation_m, thickness_deviation_m and range_m");
  const ErrorModel& errors = base.survey->errors;
  if (!errors.is_known())
    refuse_errors("from_survey = true, but the error of the survey is not known",
                  "there is too little stable ground, or both models are the same there",
                  "Give sigma_m in [preprocess.difference], or the numbers here: "
                  "terrain_deviation_m, thickness_deviation_m and range_m");
  thickness_ = errors.sigmas(base.before);
  for (const double sigma : thickness_) terrain_.push_back(sigma / std::numbers::sqrt2);
  const Variogram& v = errors.variogram();
  const double cell = base.bed.grid.cell, of_survey = base.survey->grid.cell;
  add_part(base.bed.grid, v.nugget * left_in_a_cell({}, cell, of_survey), 0);
  const auto add_sill = [&](double sill, double range) {
    add_part(base.bed.grid, sill * left_in_a_cell({0, 1, range, 0, 0, {}, {}}, cell, of_survey), range);
  };
  if (v.short_sill > 0) add_sill(v.short_sill, v.short_range);
  if (v.long_sill > 0) add_sill(v.long_sill, v.long_range);
}

void ElevationErrors::add_part(const MapGrid& grid, double share, double range) {
  if (share > 0) parts_.push_back({share, range, RandomField(grid, range, 0)});
}

void ElevationErrors::apply(SceneRasters& scene, std::int64_t member) const {
  std::vector<double> ground(scene.bed.values.size(), 0.0), release(ground.size(), 0.0);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    RandomField field = parts_[p].field;
    field.start(seed_of_field(seed_, member, p));
    const double scale = std::sqrt(parts_[p].share);
    for (auto* sum : {&ground, &release}) {
      const std::vector<double> drawn = field.next();
      for (std::size_t i = 0; i < drawn.size(); ++i) (*sum)[i] += scale * drawn[i];
    }
  }
  for (std::size_t i = 0; i < ground.size() && !terrain_.empty(); ++i) {
    const double error = deviation_at(terrain_, i) * ground[i];
    scene.bed.values[i] += error;
    scene.before.values[i] += error;
  }
  if (!thickness_.empty()) add_thickness(scene, release);
}

void ElevationErrors::add_thickness(SceneRasters& scene, const std::vector<double>& field) const {
  for (std::size_t i = 0; i < field.size(); ++i) {
    double total = 0;
    for (const Release& release : scene.releases) total += std::max(0.0, release.thickness.values[i]);
    if (!(total > 0)) continue;
    const double changed = std::max(0.0, total + deviation_at(thickness_, i) * field[i]);
    for (Release& release : scene.releases) release.thickness.values[i] *= changed / total;
    scene.before.values[i] += changed - total;
  }
}

std::string ElevationErrors::words() const {
  std::string text = "elevation error:";
  if (!terrain_.empty()) text += fmt::format(" ground {:.3g} m", middle_of(terrain_));
  if (!thickness_.empty())
    text += fmt::format("{} released thickness {:.3g} m", terrain_.empty() ? "" : ",", middle_of(thickness_));
  if (terrain_.size() > 1) text += " (medians; more on steep ground where the survey says so)";
  for (const Part& part : parts_)
    text += fmt::format(", {:.0f} % of its variance ", 100 * part.share) +
            (part.range > 0 ? fmt::format("alike over {:.0f} m", part.range) : std::string("independent"));
  return text;
}

}  // namespace talus::preprocess
