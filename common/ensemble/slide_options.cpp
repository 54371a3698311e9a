// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/slide_options.hpp"

#include <set>

#include <fmt/format.h>

namespace talus {
namespace {

constexpr recipe::Range steep{0, 90, true, true};

}  // namespace

void SlideKeyOptions::describe(recipe::Visitor& v) {
  v.text("key", key, "a key of [preprocess] or [solve] with its tables: solve.base.friction_angle_deg");
  v.text("attribute", attribute, "the attribute of the polygons that holds its value");
  v.needs(!key.empty() && !attribute.empty(), {"[[slides.set]] without key or attribute", "nothing would be set",
                                               "Write key = \"solve. ...\" and attribute = \"...\""});
}

void ScenarioOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of the slide");
  v.path("outline", outline, "vector file of its polygons: FILE|layername=LAYER|subset=CONDITION");
  v.number("thickness_m", thickness, recipe::not_negative, "released thickness (with base_dem); 0 = not given");
  v.number("depth_m", depth, recipe::not_negative,
           "largest depth of the sliding surface (with before_dem); 0 = not given");
  v.number("volume_m3", volume, recipe::not_negative, "released volume; 0 = not given");
  v.names("set", set, {}, "values of other keys, \"key=value\" each: \"solve.base.friction_angle_deg=18\"");
  const std::string shown = name.empty() ? "[[slides.scenario]]" : "[[slides.scenario]] " + name;
  v.needs(!outline.empty(), {shown + " has no outline", "its polygons are not known",
                             "Give outline = \"FILE|layername=LAYER|subset=CONDITION\""});
  v.needs(!name.empty(), {"[[slides.scenario]] without a name", "results are told apart by name", "Name it"});
  v.needs((thickness > 0) + (depth > 0) + (volume > 0) <= 1,
          {shown + ": more than one of thickness_m, depth_m and volume_m3", "each says by itself how much is released",
           "Leave the others out"});
}

void SlideOptions::describe(recipe::Visitor& v) {
  v.path("outlines", outlines,
         "vector file of polygons over the model of [preprocess], each a slide: FILE|layername=LAYER|subset=CONDITION");
  v.text("name_from", name_from, "attribute that holds their names; empty = slide-1, slide-2 and so on by feature id");
  v.text("thickness_from", thickness_from, "attribute that holds the released thickness [m] (with base_dem)");
  v.text("depth_from", depth_from,
         "attribute that holds the largest depth of the sliding surface [m] (with before_dem)");
  v.text("volume_from", volume_from, "attribute that holds the released volume [m3]");
  v.optional_number("margin_m", margin, recipe::not_negative,
                    "the domain of a slide is the rectangle around its outline, and this on all sides");
  v.number(
      "reach_angle_deg", reach_angle, steep,
      "without margin_m: the domain holds all ground that lies below a line from the slide's highest point at this "
      "angle");
  recipe::choice(v, "at_edge", at_edge, {{"flag", SlideAtEdge::flag}, {"fail", SlideAtEdge::fail}},
                 "a slide that comes to the edge of its domain is counted and named, or counts as failed");
  describe_runs(v, "slide");
  recipe::table(v, "thresholds", thresholds, "what the maps count");
  recipe::list(v, "set", vary, "a key of the recipe that takes the value of an attribute");
  recipe::list(v, "scenario", scenario, "a slide that is listed here");
}

void SlideOptions::check(std::vector<Fault>& faults) const {
  if (!on()) return;
  if (!thickness_from.empty() + !depth_from.empty() + !volume_from.empty() > 1)
    faults.push_back({"[slides]: more than one of thickness_from, depth_from and volume_from",
                      "each says by itself how much is released", "Leave the others out"});
  const bool by_layer =
      !(outlines.string() + name_from + thickness_from + depth_from + volume_from).empty() || !vary.empty();
  if (!scenario.empty() && by_layer)
    faults.push_back({"[slides]: outlines or attributes beside [[slides.scenario]]",
                      "a recipe that lists slides gives their outlines, names and values itself",
                      "Give these in [[slides.scenario]], or leave that out and have every polygon a slide"});
  std::set<std::string> keys, names;
  for (const SlideKeyOptions& one : vary)
    if (!keys.insert(one.key).second)
      faults.push_back(
          {"[[slides.set]] of " + one.key + " is there twice", "one value would hide the other", "Leave one out"});
  for (const ScenarioOptions& one : scenario) {
    if (!names.insert(one.name).second)
      faults.push_back({fmt::format("[[slides.scenario]]: name \"{}\" is taken", one.name),
                        "results are told apart by name", "Name it otherwise"});
  }
}

SlideOptions slides_of(const recipe::Recipe& recipe) { return recipe.read<SlideOptions>("slides"); }

const char* members_table(const recipe::Recipe& recipe) { return slides_of(recipe).on() ? "slides" : "ensemble"; }

}  // namespace talus
