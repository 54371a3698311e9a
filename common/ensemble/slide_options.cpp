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
  v.text("key", key,
         "a key of [preprocess] or [solve] with its tables: solve.base.friction_angle_deg; what is released: "
         "preprocess.release[0].thickness_m (base_dem), preprocess.source.sliding_surface.depth_m or volume_m3 "
         "(before_dem)");
  v.text("attribute", attribute, "the attribute of the polygons that holds its value");
  v.needs(!key.empty() && !attribute.empty(), {"[[slides.set]] without key or attribute", "nothing would be set",
                                               "Write key = \"solve. ...\" and attribute = \"...\""});
}

void ScenarioOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of the slide");
  v.path("outline", outline, "vector file of its polygons: FILE|layername=LAYER|subset=CONDITION");
  v.names("set", set, {}, "values of keys, \"key=value\" each: \"preprocess.release[0].thickness_m=3\"");
  const std::string shown = name.empty() ? "[[slides.scenario]]" : "[[slides.scenario]] " + name;
  v.needs(!outline.empty(), {shown + " has no outline", "its polygons are not known",
                             "Give outline = \"FILE|layername=LAYER|subset=CONDITION\""});
  v.needs(!name.empty(), {"[[slides.scenario]] without a name", "results are told apart by name", "Name it"});
}

void SlideOptions::describe(recipe::Visitor& v) {
  v.path("outlines", outlines,
         "vector file of polygons over the model of [preprocess], each a slide: FILE|layername=LAYER|subset=CONDITION");
  v.text("name_from", name_from, "attribute that holds their names; empty = slide-1, slide-2 and so on by feature id");
  v.optional_number("margin_m", margin, recipe::not_negative,
                    "the domain of a slide is the rectangle around its outline, and this on all sides");
  v.number(
      "reach_angle_deg", reach_angle, steep,
      "without margin_m: the domain holds all ground that lies below a line from the slide's highest point at this "
      "angle");
  recipe::choice(v, "at_edge", at_edge, {{"flag", SlideAtEdge::flag}, {"fail", SlideAtEdge::fail}},
                 "a slide that comes to the edge of its domain is counted and named, or counts as failed");
  recipe::list(v, "set", vary, "a key of the recipe that takes the value of an attribute");
  recipe::list(v, "scenario", scenario, "a slide that is listed here");
}

void SlideOptions::check(std::vector<Fault>& faults) const {
  if (!on()) return;
  const bool by_layer = !outlines.empty() || !name_from.empty() || !vary.empty();
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

}  // namespace talus
