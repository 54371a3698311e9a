// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/survey_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/read_raster.hpp"
#include "common/gis/resampling.hpp"
#include "common/stage/findings.hpp"

namespace talus::postprocess {
namespace {

/// No survey is free of error: 0 is what comes out where one model was made from the other.
void refuse_zeros(const std::filesystem::path& file, const Raster& sigma) {
  if (std::any_of(sigma.values.begin(), sigma.values.end(), [](double s) { return s > 0; })) return;
  throw DataError({file.string() + ": a standard error of 0 m everywhere", "no survey is free of error",
                   "Give its true error (sigma_m), or leave sigma out: no score carries an error then"});
}

/// The raster of sigma on the survey's grid. A measured value without a sigma, or with one of 0, is not known well
/// enough to be compared; a measured 0 stands for ground that was mapped as untouched, and needs none.
std::vector<double> read_sigma(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty()) return std::vector<double>(survey.grid.count(), options.sigma_m);
  auto raster = read_raster(options.sigma);
  check_crs(options.sigma, raster.grid, maps.grid);
  survey.inputs.push_back(options.sigma);
  if (!options.thickness.empty()) to_vertical(raster, options, maps);
  if (!same_grid(raster.grid, survey.grid)) raster = resample_elevation(raster, survey.grid);
  refuse_zeros(options.sigma, raster);
  std::size_t without = 0;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    double& sigma = raster.values[i];
    if (sigma < 0)
      throw DataError({fmt::format("{}: a standard error of {:g} m", options.sigma.string(), sigma),
                       "it cannot be negative", "Give the raster of 1 sigma, in metres"});
    if (sigma > 0 || std::isnan(survey.measured[i])) continue;
    if (survey.measured[i] == 0) {
      sigma = 0;
      continue;
    }
    survey.measured[i] = std::numeric_limits<double>::quiet_NaN();
    ++without;
  }
  if (without > 0) survey.notes.push_back(fmt::format("{} surveyed cells without a sigma are left out.", without));
  return raster.values;
}

}  // namespace

void read_error(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty() && options.sigma_m == 0) return;
  auto& error = survey.error;
  error.sigma = read_sigma(options, maps, survey);
  error.detection = 1.96;  // 95 %
  error.correlation_length = options.correlation_length;
  if (options.correlation_length == 0 && !options.sigma.empty())
    error.correlation_length = std::max(0.0, raster_item(options.sigma, "CORRELATION_LENGTH_M").value_or(0));
  if (error.correlation_length > 0) return;
  warn("unknown-correlation-length",
       "[postprocess.survey] The range of the survey's errors is not known: they are drawn for every cell for itself, "
       "which makes the spread of scores too small. Give correlation_length_m.");
}

DetectedChange detected(const Survey& survey, const std::vector<double>& value) {
  DetectedChange seen{value, value};
  const auto& error = survey.error;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool detected = error.sigma.empty() || !(std::abs(value[i]) < error.detection * error.sigma[i]);
    if (std::isnan(value[i])) continue;
    seen.deposit[i] = detected ? std::max(0.0, value[i]) : 0;
    seen.footprint[i] = detected ? std::abs(value[i]) : 0;
  }
  return seen;
}

}  // namespace talus::postprocess
