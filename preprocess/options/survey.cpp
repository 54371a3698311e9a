// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/survey.hpp"

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

namespace {

/// This function declares that `what`, where it is given, needs a second elevation model.
void need_second_model(recipe::Visitor& v, const Options& all, bool given, const std::string& what) {
  v.needs(all.in_laboratory() || !all.after_dem.empty() || !given,
          fault(what + " is given without after_dem", "it speaks of a second elevation model",
                "Give after_dem, or leave it out"));
}

}  // namespace

void CoregistrationOptions::describe(recipe::Visitor& v, const Options& all) {
  recipe::choice(v, "mode", mode, {{"check", Alignment::check}, {"apply", Alignment::apply}, {"off", Alignment::off}},
                 "bring after_dem onto before_dem where nothing moved: check = find shift, height and tilt, and warn; "
                 "apply = correct them");
  need_second_model(v, all, mode == Alignment::apply, "coregistration.mode = \"apply\"");
  v.path("changed", changed,
         "polygons of ground to leave out of the fit, besides source and deposit; changes that stand out are found by "
         "themselves");
  need_second_model(v, all, !changed.empty(), "coregistration.changed");
}

void DifferenceOptions::describe(recipe::Visitor& v, const Options& all) {
  v.number("confidence", confidence, recipe::Range{0.5, 0.9999}, "of the level of detection, two-sided");
  v.number("minimum_level_m", minimum_level, recipe::not_negative, "the least level of detection in any case");
  v.number("sigma_m", sigma, recipe::not_negative,
           "standard error of the difference, the root of the sum of both models' squares; 0 = by slope, from stable "
           "ground");
  need_second_model(v, all, sigma > 0 || minimum_level > 0, "an error or level in [preprocess.difference]");
}

void DepositOptions::describe(recipe::Visitor& v, const Options& all) {
  v.path("polygon", polygon,
         "outline of the surveyed deposit; empty = what rose in the regions of change that belong to the slide: beside "
         "the source, beside one another, or down the way that a flow takes from them");
  need_second_model(v, all, !polygon.empty(), "deposit.polygon");
  v.number("threshold_m", threshold, recipe::not_negative,
           "rise beyond which (and beyond the level of detection) a cell belongs to it");
}

}  // namespace talus::preprocess
