// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <regex>

#include "common/recipe/paths.hpp"
#include "common/recipe/recipe.hpp"
#include "common/recipe/used.hpp"
#include "common/stage/identity.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::holds;
using test::SampleOptions;
using test::Scratch;

using recipe::to_toml;

SampleOptions read_back(const std::string& text) {
  const Scratch scratch;
  return recipe::Recipe(scratch.write("r.toml", text)).read<SampleOptions>("solve");
}

/// Comments of the template taken off its example of a list.
std::string uncommented_example(const std::string& text) {
  const std::size_t from = text.find("# [[solve.release]]");
  return text.substr(0, from) + std::regex_replace(text.substr(from), std::regex("(^|\n)# "), "$1");
}

TEST(RecipeWriter, templates_their_examples_and_options_in_use_read_back_exactly) {
  EXPECT_EQ(read_back(to_toml(SampleOptions{}, "solve", true)), SampleOptions{});
  const SampleOptions example = read_back(uncommented_example(to_toml(SampleOptions{}, "solve", true)));
  EXPECT_EQ(example.releases, std::vector<test::Release>{test::Release{}});
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
    EXPECT_TRUE(holds(text, {expected})) << expected << "\nis not in\n" << text;
}

TEST(RecipeWriter, keys_stand_before_sub_tables_and_numbers_are_floats) {
  const std::string text = to_toml(SampleOptions{}, "solve", false);
  EXPECT_LT(text.find("steps ="), text.find("[solve.material]"));
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
  EXPECT_TRUE(holds(text, {"steps = 11  # default: 10\n", "friction_angle_deg = 30.0  # default: 25.0\n",
                           "seed_x_m = 4.0  # default: none\n", "density_kg_m3 = 2000.0\n"}));
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

TEST(UsedRecipe, reads_back_facts_values_and_defaults_whatever_stands_in_the_texts_and_refuses_what_is_no_toml) {
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
  EXPECT_TRUE(holds(test::fault_of<DataError>([] { recipe::read_used_recipe("\n[solve\n", "solve.used.toml"); }),
                    {"solve.used.toml:2: not TOML"}));
}

struct Overrides : test::InScratch {
  recipe::Recipe recipe(const std::vector<std::string>& set) {
    return recipe::Recipe(scratch.write("r.toml", text), set);
  }
  SampleOptions read(std::vector<std::string> set) { return recipe(std::move(set)).read<SampleOptions>("solve"); }
  /// What is said of one value, behind the words of the command line.
  void expect_refused(const std::string& word, const std::string& why) {
    EXPECT_EQ(faults({word}), "--set " + word + why);
  }
  std::string faults(std::vector<std::string> set) {
    return scratch.from_here(fault_of<RecipeError>([&] { read(std::move(set)); }), "");
  }

  std::string text = R"([scene]
name = "valley"
[solve]
steps = 7
times_s = [1, 2]
[[solve.release]]
name = "A"
thickness_m = 2
[[solve.release]]
name = "B"
)";
};

TEST_F(Overrides, take_the_place_of_values_and_make_tables_that_are_missing) {
  const SampleOptions options =
      read({"solve.steps=8", "solve.density_kg_m3=2.5e3", "solve.verbose=true", "solve.material.friction_angle_deg=31",
            "solve.material.tension_pa=0", "solve.times_s=[3, 4.5, 5]", "solve.shape='linear'"});
  EXPECT_EQ(options.steps, 8);
  EXPECT_EQ(options.density, 2500);
  EXPECT_TRUE(options.verbose);
  EXPECT_EQ(options.material.friction, 31);
  EXPECT_EQ(options.material.tension, 0);
  EXPECT_EQ(options.times, (std::vector<double>{3, 4.5, 5}));
  EXPECT_EQ(options.shape, test::Shape::linear);
  EXPECT_EQ(options.releases.size(), 2u);
}

TEST_F(Overrides, a_word_that_is_no_toml_is_text) {
  EXPECT_EQ(read({"solve.shape=linear"}).shape, test::Shape::linear);
  EXPECT_EQ(read({"solve.label=a \"word\" of Gletsch\u00e4r # more"}).label, "a \"word\" of Gletsch\u00e4r # more");
  EXPECT_EQ(read({"solve.label=two\nlines = 1"}).label, "two\nlines = 1");
  EXPECT_EQ(read({"solve.label="}).label, "");
  EXPECT_EQ(read({"solve.terrain=dem/before.tif"}).terrain, scratch / "dem/before.tif");
}

TEST_F(Overrides, reach_items_of_lists_by_number_and_the_last_of_several_holds) {
  const SampleOptions options =
      read({"solve.release[1].thickness_m=5", "solve.release[0].name=first", "solve.times_s[1]=9"});
  ASSERT_EQ(options.releases.size(), 2u);
  EXPECT_EQ(options.releases[0].name, "first");
  EXPECT_EQ(options.releases[0].thickness, 2);
  EXPECT_EQ(options.releases[1].name, "B");
  EXPECT_EQ(options.releases[1].thickness, 5);
  EXPECT_EQ(options.times, (std::vector<double>{1, 9}));
  EXPECT_EQ(read({"solve.release=[{name = \"C\"}]"}).releases.size(), 1u);
  EXPECT_EQ(read({"solve.steps=8", "solve.steps=9"}).steps, 9);
}

TEST_F(Overrides, are_refused_with_the_words_of_the_recipe_and_their_own_place) {
  expect_refused("solve.steps=0", ": [solve] steps = 0 (out of range). It must be 1 to 1000");
  expect_refused("solve.steps=many",
                 ": [solve] steps = \"many\" (it is text). Give an integer, without a decimal point");
  expect_refused("solve.densty_kg_m3=1", ": unknown key \"densty_kg_m3\" in [solve]. Did you mean \"density_kg_m3\"?");
  expect_refused("solve.materal.friction_angle_deg=1",
                 ": unknown key \"materal\" in [solve]. Did you mean \"material\"?");
  expect_refused("solv.steps=1", ": unknown top-level table \"solv\". Did you mean \"solve\"?");
  EXPECT_EQ(
      faults({"solve.release[1].thickness_m=-1"}),
      "--set solve.release[1].thickness_m=-1: [[solve.release]] thickness_m = -1 (out of range). It must be >= 0");
}

TEST_F(Overrides, that_lead_nowhere_are_refused_all_at_once) {
  const char* const form = "Write --set key=value, the key with its tables: --set solve.end_time_s=60";
  EXPECT_EQ(faults({"solve.steps"}), std::string("--set solve.steps (there is no value). ") + form);
  EXPECT_EQ(faults({"solve..steps=1", "=1", "solve.=1"}), std::string("--set solve..steps=1 (this is no key). ") +
                                                              form + "\n--set =1 (this is no key). " + form +
                                                              "\n--set solve.=1 (this is no key). " + form);
  expect_refused("solve.release[x].name=1",
                 " (this is no key). Give the number of an item, counted from 0: --set 'solve.part[0].release=A'");
  expect_refused("solve.release[2].name=C",
                 " (solve.release has 2 items, counted from 0). Name one that is there, or add it to the recipe");
  EXPECT_EQ(
      faults({"solve.part[0].name=C"}),
      "--set solve.part[0].name=C (the recipe has no list solve.part). Give the whole list: --set 'solve.part=[...]'");
  expect_refused("solve.steps[0]=1", " (solve.steps is no list). Leave the [] out");
  expect_refused("solve.steps.x=1", " (solve.steps is no table). Leave out what comes behind it");
  EXPECT_EQ(
      faults({"solve.release.name=A"}),
      "--set solve.release.name=A (solve.release is a list). Name one of its items, counted from 0: solve.release[0]");
  EXPECT_TRUE(holds(faults({"solve.times_s=[1, 2"}), {"--set solve.times_s=[1, 2 (the value is not TOML: "}));
}

/// What is said on the command line makes what was computed with other values stale, as the recipe's file does.
TEST_F(Overrides, belong_to_their_recipe_alone_and_change_the_mark_of_their_table_as_the_file_would) {
  const recipe::Recipe changed = recipe({"solve.steps=8"}), plain = recipe({});
  EXPECT_EQ(changed.overrides(), std::vector<std::string>{"solve.steps=8"});
  EXPECT_EQ(changed.with({"solve.verbose=true"}).overrides(), changed.overrides());
  EXPECT_TRUE(plain.overrides().empty());
  EXPECT_EQ(plain.read<SampleOptions>("solve").steps, 7);
  const std::string before = recipe_mark(recipe({}), "solve"), set = recipe_mark(recipe({"solve.steps=8"}), "solve");
  EXPECT_NE(set, before);
  text.replace(text.find("steps = 7"), 9, "steps = 8");
  EXPECT_EQ(recipe_mark(recipe({}), "solve"), set);
}

struct PathsShown : testing::Test {
  ShownPaths paths;
  BindShownPaths bind{paths};
};

TEST_F(PathsShown, stand_for_whole_names_the_longest_first) {
  show_path_as("/maps/a/scene", "", "");
  show_path_as("/maps/a/scene/out", "results", "out");
  EXPECT_EQ(with_shown_paths("/maps/a/scene/before.tif: no such file"), "before.tif: no such file");
  EXPECT_EQ(with_shown_paths("gdalwarp /maps/a/scene/x.tif out.tif"), "gdalwarp x.tif out.tif");
  EXPECT_EQ(with_shown_paths("/maps/a/scene/out/run.h5"), "results/run.h5");
  EXPECT_EQ(with_shown_paths("/maps/a/scene/outer.tif"), "outer.tif");
  EXPECT_EQ(with_shown_paths("/maps/a/scenery/x.tif"), "/maps/a/scenery/x.tif");
  EXPECT_EQ(with_shown_paths("/mnt/maps/a/scene/x.tif"), "/mnt/maps/a/scene/x.tif");
  EXPECT_EQ(with_shown_paths("in /maps/a/scene."), "in ..");
}

TEST_F(PathsShown, leave_no_folder_of_the_machine_in_a_report) {
  show_path_as("/maps/a/scene", "/maps/a/scene", "");
  EXPECT_EQ(without_absolute_paths("/maps/a/scene/before.tif  sha256 12"), "before.tif  sha256 12");
  EXPECT_EQ(without_absolute_paths("\"/data/secret/dem.tif\""), "\"\u2026/dem.tif\"");
  EXPECT_EQ(without_absolute_paths("talus-solve /tmp/x/recipe.toml --out=/tmp/y"),
            "talus-solve \u2026/recipe.toml --out=\u2026/y");
  EXPECT_EQ(without_absolute_paths("NETCDF:\"/d/e/f.nc\":z"), "NETCDF:\"\u2026/f.nc\":z");
  EXPECT_EQ(without_absolute_paths("5 m/s, H/L 0.4, 1 / 2, https://a/b"), "5 m/s, H/L 0.4, 1 / 2, https://a/b");
}

TEST_F(PathsShown, are_known_once_a_recipe_is_read) {
  const test::Scratch scratch;
  std::filesystem::create_directories(scratch / "deep");
  const auto file = scratch.write("deep/r.toml", "[solve]\nterrain = \"../dem.tif\"\n");
  const auto from = std::filesystem::current_path();
  std::filesystem::current_path(scratch.folder());
  const recipe::Recipe recipe("deep/r.toml");
  const auto options = recipe.read<test::SampleOptions>("solve");
  std::filesystem::current_path(from);
  EXPECT_EQ(with_shown_paths(options.terrain.string() + ": no"), "dem.tif: no") << "from where the program was called";
  EXPECT_EQ(without_absolute_paths(options.terrain.string()), "../dem.tif") << "from the recipe";
}

TEST_F(PathsShown, are_those_of_the_object_that_is_bound) {
  show_path_as("/maps/a", "here", "");
  {
    ShownPaths others;
    const BindShownPaths inner(others);
    EXPECT_EQ(with_shown_paths("/maps/a/x.tif"), "/maps/a/x.tif");
  }
  EXPECT_EQ(with_shown_paths("/maps/a/x.tif"), "here/x.tif");
}

}  // namespace
}  // namespace talus
