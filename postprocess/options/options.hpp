// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Table [postprocess] of a recipe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "postprocess/options/hazard.hpp"
#include "postprocess/options/survey.hpp"
#include "postprocess/options/writer.hpp"

namespace talus::postprocess {

/// The keys of [postprocess].
struct Options {
  std::filesystem::path run;         // empty = OUT/run.h5
  double footprint_threshold = 1.0;  // [m]
  double deposit_threshold = 1.0;    // [m]
  std::vector<double> classes;       // lower limits of the thickness classes [m]; empty = by the deposit's thickness
  std::string institution;
  std::vector<std::string> outputs{"report", "report-3d", "surface", "terrain"};  // words of the writers
  std::string start_time;         // when the failure began, UTC; empty = not known
  std::filesystem::path thalweg;  // line along which run-out is measured; empty = found from the run
  SurveyOptions survey;
  IntensityOptions intensity;
  ReachConeOptions reach_cone;
  BuildingOptions buildings;
  HazardOptions hazard;
  Writers writers;
  std::vector<std::string> accept;  // what is refused as implausible, insisted on by name

  /// True if `outputs` has the word.
  bool writes(std::string_view word) const;
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
