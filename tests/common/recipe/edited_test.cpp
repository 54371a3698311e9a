// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Values put into the text of a recipe.
#include <gtest/gtest.h>

#include "common/recipe/edited.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::recipe {
namespace {

constexpr const char* slide_recipe =
    "# of the Straße\n"
    "[scene]\nname = \"slide\"\n\n"
    "[solve]\n"
    "end_time_s = 60      # generous\n\n"
    "[solve.base]   # the bed\n"
    "law = \"coulomb\"\n"
    "friction_angle_deg = 22.0 # a first guess, ±5\n\n"
    "[[solve.part]]\n"
    "release = \"Fläche 1\"\n"
    "material = { density_kg_m3 = 2000.0 }\n\n"
    "[postprocess]\noutputs = [\n  \"report\",\n  \"points\",\n]\n";

void expect_same_recipe(const std::string& now, const std::vector<std::string>& values) {
  const Recipe edited = Recipe::parse(now), wanted = Recipe::parse(slide_recipe, ".", values);
  for (const char* table : {"scene", "preprocess", "solve", "postprocess", "ensemble"})
    EXPECT_EQ(edited.canonical(table), wanted.canonical(table)) << now;
}

TEST(EditedRecipe, keeps_all_but_the_value) {
  const std::string now = edited(slide_recipe, {"solve.base.friction_angle_deg=17.25"});
  std::string wanted = slide_recipe;
  wanted.replace(wanted.find("22.0"), 4, "17.25");
  EXPECT_EQ(now, wanted);
}

TEST(EditedRecipe, has_the_values_wherever_they_go) {
  const std::vector<std::vector<std::string>> all{
      {"solve.end_time_s=30", "solve.end_time_s=45"},
      {"solve.base.law=voellmy", "solve.base.turbulence_m_s2=1000.0"},
      {"solve.material.density_kg_m3=1900.0", "solve.material.model=\"mu-of-i\""},
      {"solve.part[0].release=Fläche 2"},
      {"solve.part[0].material.density_kg_m3=2100.0"},
      {"solve.part[0].material.cohesion_Pa=5.0"},
      {"postprocess.outputs=[]", "postprocess.friction_is=fitted"},
      {"ensemble.budget.friction_doubt=0.2"},
      {"preprocess.release=[{thickness_m = 3.0}]"}};
  for (const auto& values : all) expect_same_recipe(edited(slide_recipe, values), values);
}

TEST(EditedRecipe, puts_a_new_key_below_the_head_of_its_table) {
  const std::string now = edited(slide_recipe, {"postprocess.friction_is=fitted"});
  EXPECT_NE(now.find("[postprocess]\nfriction_is = \"fitted\"\noutputs"), std::string::npos) << now;
  EXPECT_NE(now.find("# of the Straße"), std::string::npos);
}

}  // namespace
}  // namespace talus::recipe
