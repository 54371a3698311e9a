// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>

#include "common/recipe/used.hpp"
#include "common/recipe/values.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using recipe::to_toml;
using test::SampleOptions;
using test::Scratch;

SampleOptions read_back(const std::string& text) {
  const Scratch scratch;
  return recipe::Recipe(scratch.write("r.toml", text)).read<SampleOptions>("solve");
}

/// Comments of the template taken off its example of a list.
std::string uncommented_example(const std::string& text) {
  const std::size_t from = text.find("# [[solve.release]]");
  std::string result = text.substr(0, from);
  std::size_t at = from;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    std::string line = text.substr(at, end - at);
    if (line.starts_with("# ")) line.erase(0, 2);
    result += line + "\n";
    at = end + 1;
  }
  return result;
}

TEST(RecipeWriter, template_of_the_defaults_reads_back_to_the_defaults) {
  EXPECT_EQ(read_back(to_toml(SampleOptions{}, "solve", true)), SampleOptions{});
}

struct Rows {
  recipe::Pairs line{{0, 1}, {2.5, 3}};
  void describe(recipe::Visitor& v) { v.pairs("line_m", line, recipe::not_negative, "a line"); }
};

TEST(RecipeWriter, rows_of_two_numbers_read_back_and_others_are_refused) {
  EXPECT_EQ(to_toml(Rows{}, "solve", false), "[solve]\nline_m = [[0.0, 1.0], [2.5, 3.0]]\n");
  const auto read = [](const std::string& text) { return recipe::Recipe::parse(text).read<Rows>("solve").line; };
  EXPECT_EQ(read("[solve]\n"), Rows{}.line);
  EXPECT_EQ(read("[solve]\nline_m = [[4, 5.5]]"), (recipe::Pairs{{4, 5.5}}));
  EXPECT_EQ(test::fault_of<RecipeError>([&] { read("[solve]\nline_m = [[1, 2], [3], 4, [5, -6]]"); }),
            "recipe.toml:2:19: [solve] line_m[1] (a row of two numbers is wanted). Write line_m = [[a, b], ...]\n"
            "recipe.toml:2:24: [solve] line_m[2] = 4 (a row of two numbers is wanted). Write line_m = [[a, b], ...]\n"
            "recipe.toml:2:31: [solve] line_m[3][1] = -6 (out of range). It must be >= 0");
}

TEST(RecipeWriter, template_shows_help_range_and_choices_of_every_key) {
  const std::string text = to_toml(SampleOptions{}, "solve", true);
  for (const char* expected :
       {"[solve]\n", "# density of the moving mass [> 0]\ndensity_kg_m3 = 2000.0\n",
        "# a point inside the source\n# seed_x_m = ...\n", "# how many [1 to 1000]\nsteps = 10\n",
        "# shape functions [\"linear\", \"quadratic\" or \"cubic\"]\nshape = \"quadratic\"\n",
        "# what moves\n[solve.material]\n# internal friction [>= 0 and < 90]\nfriction_angle_deg = 25.0\n",
        "# # what fails; several allowed\n# [[solve.release]]\n# # name of the release\n# name = \"\"\n"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << "\nis not in\n" << text;
}

TEST(RecipeWriter, keys_stand_before_sub_tables_whatever_the_order_of_the_visit) {
  const std::string text = to_toml(SampleOptions{}, "solve", false);
  EXPECT_LT(text.find("steps ="), text.find("[solve.material]"));
}

TEST(RecipeWriter, example_of_a_list_works_once_uncommented) {
  const SampleOptions options = read_back(uncommented_example(to_toml(SampleOptions{}, "solve", true)));
  EXPECT_EQ(options.releases, std::vector<test::Release>{test::Release{}});
}

TEST(RecipeWriter, options_in_use_read_back_exactly) {
  SampleOptions options;
  options.density = 0.1 + 0.2;
  options.seed_x = 5e6 / 3;
  options.steps = 999;
  options.verbose = true;
  options.label = "tab\t, newline\n, umlaut \xc3\xbc, \"quotes\"";
  options.terrain = "/data/a \"b\".tif";
  options.times = {std::numeric_limits<double>::denorm_min(), 1e300};
  options.shape = test::Shape::cubic;
  options.material.friction = 35;
  options.material.tension = 0;
  options.releases = {{"A", 1.5, "/a.gpkg"}, {"B", 2, ""}};
  EXPECT_EQ(read_back(to_toml(options, "solve", false)), options);
  EXPECT_EQ(read_back(to_toml(options, "solve", true)), options);
}

TEST(RecipeWriter, numbers_are_floats_in_toml) {
  EXPECT_EQ(recipe::toml_number(5), "5.0");
  EXPECT_EQ(recipe::toml_number(0.1), "0.1");
  EXPECT_EQ(recipe::toml_number(1e-7), "1e-07");
  EXPECT_EQ(recipe::toml_number(recipe::infinity), "inf");
}

/// The key as a *.used.toml gives it back.
recipe::UsedKey key_of(const recipe::UsedRecipe& used, const std::string& table, const std::string& key) {
  for (const auto& item : used.keys)
    if (item.table == table && item.key == key) return item;
  ADD_FAILURE() << table << "." << key << " is missing";
  return {};
}

TEST(UsedRecipe, marks_what_was_changed_from_its_default_and_nothing_else) {
  EXPECT_EQ(recipe::to_used_toml(SampleOptions{}, "solve"), to_toml(SampleOptions{}, "solve", false));
  SampleOptions options;
  options.steps = 11;
  options.material.friction = 30;
  options.seed_x = 4;
  const auto text = recipe::to_used_toml(options, "solve");
  EXPECT_NE(text.find("steps = 11  # default: 10\n"), std::string::npos) << text;
  EXPECT_NE(text.find("friction_angle_deg = 30.0  # default: 25.0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("seed_x_m = 4.0  # default: none\n"), std::string::npos) << text;
  EXPECT_NE(text.find("density_kg_m3 = 2000.0\n"), std::string::npos) << text;
  EXPECT_EQ(read_back(text), options);
}

TEST(UsedRecipe, items_of_a_list_are_held_against_a_new_item) {
  SampleOptions options;
  options.releases = {{"A", 0, ""}, {"", 1.5, ""}};
  const auto used = recipe::read_used_recipe(recipe::to_used_toml(options, "solve"), "x");
  EXPECT_EQ(key_of(used, "solve.release 1", "name").default_value, "\"\"");
  EXPECT_FALSE(key_of(used, "solve.release 1", "thickness_m").default_value);
  EXPECT_EQ(key_of(used, "solve.release 2", "thickness_m").default_value, "0.0");
  EXPECT_FALSE(key_of(used, "solve.release 2", "name").default_value);
}

TEST(UsedRecipe, reads_back_facts_values_and_defaults_whatever_stands_in_the_texts) {
  SampleOptions options;
  options.label = "\xc3\xbc \" # default: no\nlonger";
  options.times = {1, 2};
  const auto used = recipe::read_used_recipe("# What: was used\n# input: /a: b  sha256 0\n\n[scene]\nname = \"s\"\n\n" +
                                                 recipe::to_used_toml(options, "solve"),
                                             "x");
  ASSERT_EQ(used.facts.size(), 2U);
  EXPECT_EQ(used.facts[1], (std::pair<std::string, std::string>{"input", "/a: b  sha256 0"}));
  const auto label = key_of(used, "solve", "label");
  EXPECT_EQ(label.value, recipe::toml_text(options.label));
  EXPECT_EQ(label.default_value, recipe::toml_text(SampleOptions{}.label));
  EXPECT_EQ(key_of(used, "solve", "times_s").value, "[1.0, 2.0]");
  EXPECT_EQ(key_of(used, "solve", "times_s").default_value, "[0.0, 2.5, 1e-07]");
  EXPECT_FALSE(key_of(used, "solve.material", "tension_pa").default_value);
  EXPECT_EQ(key_of(used, "solve.material", "tension_pa").value, "inf");
  EXPECT_EQ(used.keys.front().key, "density_kg_m3") << "the order of the file";
}

TEST(UsedRecipe, refuses_what_is_not_toml) {
  EXPECT_NE(test::fault_of<DataError>([] {
              recipe::read_used_recipe("\n[solve\n", "solve.used.toml");
            }).find("solve.used.toml:2: not TOML"),
            std::string::npos);
}

}  // namespace
}  // namespace talus
