// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <functional>

#include "common/recipe/gone_keys.hpp"
#include "common/recipe/paths.hpp"
#include "common/recipe/suggest.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::begins;
using test::fault_of;
using test::SampleOptions;
using test::Scratch;
using test::Shape;

using recipe::Recipe;

struct RecipeFile : test::InScratch {
  SampleOptions read(const std::string& text) {
    return Recipe(scratch.write("r.toml", text)).read<SampleOptions>("solve");
  }
  /// Faults of a recipe, with the folder taken out: "r.toml:1:1: ...".
  std::string faults(const std::string& text) {
    return scratch.from_here(fault_of<RecipeError>([&] { read(text); }), "");
  }
};

TEST_F(RecipeFile, is_the_same_as_its_text) {
  const std::string text = "[solve]\nsteps = 7\nterrain = \"dem/before.tif\"\n";
  const Recipe parsed = Recipe::parse(text, scratch.folder(), {"solve.steps=8"});
  EXPECT_EQ(parsed.read<SampleOptions>("solve").steps, 8);
  EXPECT_EQ(parsed.read<SampleOptions>("solve").terrain, read(text).terrain);
  EXPECT_EQ(parsed.canonical("solve"), Recipe(scratch.write("r.toml", text), {"solve.steps=8"}).canonical("solve"));
  EXPECT_EQ(fault_of<RecipeError>([] { Recipe::parse("[solve]\nsteps = many\n"); }).substr(0, 18),
            "recipe.toml:2:9: t");
}

TEST_F(RecipeFile, reads_every_kind_of_key_and_gives_defaults_where_empty) {
  const SampleOptions options = read(R"(
[scene]
name = "frank-slide"
title = "Frank Slide 1903"
[solve]
density_kg_m3 = 2650
seed_x_m = -3.5
steps = 7
verbose = true
label = "x"
terrain = "dem/before.tif"
times_s = [1, 2.5]
points_per_cell = [1, 2, 3]
shape = "linear"
[solve.material]
friction_angle_deg = 0
tension_pa = inf
[[solve.release]]
name = "A"
thickness_m = 2
[[solve.release]]
name = "B"
polygons = "/data/b.gpkg"
[postprocess]
anything = "is another stage's business"
)");
  EXPECT_EQ(options.density, 2650);
  EXPECT_EQ(options.seed_x, -3.5);
  EXPECT_EQ(options.steps, 7);
  EXPECT_TRUE(options.verbose);
  EXPECT_EQ(options.label, "x");
  EXPECT_EQ(options.terrain, scratch / "dem/before.tif");
  EXPECT_EQ(options.times, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(options.points_per_cell, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(options.shape, Shape::linear);
  EXPECT_EQ(options.material.friction, 0);
  EXPECT_EQ(options.material.tension, recipe::infinity);
  ASSERT_EQ(options.releases.size(), 2u);
  EXPECT_EQ(options.releases[0].name, "A");
  EXPECT_EQ(options.releases[0].thickness, 2);
  EXPECT_EQ(options.releases[1].polygons, "/data/b.gpkg");
  EXPECT_EQ(read(""), SampleOptions{});
}

TEST_F(RecipeFile, names_the_scene_by_its_table_or_by_its_file) {
  const Recipe named(scratch.write("named.toml", "[scene]\nname = \"frank\"\ntitle = \"Frank Slide\""));
  EXPECT_EQ(named.scene_name(), "frank");
  EXPECT_EQ(named.title(), "Frank Slide");
  const Recipe bare(scratch.write("valley.toml", ""));
  EXPECT_EQ(bare.scene_name(), "valley");
  EXPECT_EQ(bare.title(), "valley");
  EXPECT_EQ(bare.file(), scratch / "valley.toml");
}

TEST_F(RecipeFile, reports_all_faults_at_once_in_the_order_of_the_file) {
  EXPECT_EQ(
      faults("[solve]\nshape = \"cubik\"\ndensty_kg_m3 = 1\nsteps = 0\n[solve.material]\nfriction_angle_deg = 90\n"),
      "r.toml:2:9: [solve] shape = \"cubik\" (no such choice). Did you mean \"cubic\"? It must be \"linear\", "
      "\"quadratic\" or \"cubic\"\n"
      "r.toml:3:1: unknown key \"densty_kg_m3\" in [solve]. Did you mean \"density_kg_m3\"?\n"
      "r.toml:4:9: [solve] steps = 0 (out of range). It must be 1 to 1000\n"
      "r.toml:6:22: [solve.material] friction_angle_deg = 90 (out of range). It must be >= 0 and < 90");
}

TEST_F(RecipeFile, says_the_first_fifty_of_many_faults_and_counts_the_rest) {
  const std::size_t count = 100'000;
  const auto lines = [&](const std::string& head, const std::function<std::string(std::size_t)>& line) {
    std::string text = head;
    for (std::size_t i = 0; i < count; ++i) text += line(i);
    return text;
  };
  const auto key = [](std::size_t i) { return "key_" + std::to_string(i) + " = 1\n"; };
  for (const std::string& text : {
           lines("[solve]\n", key),
           lines("[solve.material]\n", key),
           lines("[[solve.release]]\n", key),
           lines("", [](std::size_t) { return std::string("[[solve.release]]\nthickness_m = -1\n"); }),
           lines("", [](std::size_t) { return std::string("[[solve.release]]\nnmae = 1\n"); }),
           lines("", [](std::size_t) { return std::string("[[solve.release]]\nname = 1\nnmae = 1\n"); }),
           lines("[solve]\ntimes_s = [", [](std::size_t) { return std::string("true, "); }) + "]\n",
       }) {
    const std::string said = faults(text);
    EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 51) << said.substr(0, 300);
    EXPECT_GT(said.size(), 20u) << text.substr(0, 100);
  }
  const std::string said = faults(lines("[solve]\n", key));
  EXPECT_NE(said.find("r.toml: 99950 more faults. Mend those above first"), std::string::npos) << said.substr(5000);
}

TEST_F(RecipeFile, refuses_wrong_types_and_numbers_that_are_not_finite) {
  const std::pair<std::string, std::string> keys[] = {
      {"density_kg_m3 = \"heavy\"", "17: [solve] density_kg_m3 = \"heavy\" (it is text). Give a number"},
      {"steps = 3.0",
       "9: [solve] steps = 3.0 (it is a number with a decimal point). Give an integer, without a decimal point"},
      {"verbose = 1", "11: [solve] verbose = 1 (it is an integer). Give true or false"},
      {"label = [1]", "9: [solve] label (it is a list). Give text in quotes"},
      {"terrain = 5", "11: [solve] terrain = 5 (it is an integer). Give a path in quotes"},
      {"times_s = 4", "11: [solve] times_s = 4 (a list is wanted). Write times_s = [...]"},
      {"seed_x_m = 1979-05-27", "12: [solve] seed_x_m (it is a date or time). Give a number"},
      {"density_kg_m3 = nan", "17: [solve] density_kg_m3 = nan (it is not a finite number). Give a number > 0"},
      {"density_kg_m3 = inf", "17: [solve] density_kg_m3 = inf (it is not a finite number). Give a number > 0"},
      {"steps = 5000000000", "9: [solve] steps = 5000000000 (out of range). It must be 1 to 1000"}};
  for (const auto& [line, fault] : keys) EXPECT_EQ(faults("[solve]\n" + line), "r.toml:2:" + fault);
  EXPECT_EQ(faults("[solve]\nshape = 2"),
            "r.toml:2:9: [solve] shape = 2 (it is an integer). Give \"linear\", \"quadratic\" or \"cubic\"");
}

TEST_F(RecipeFile, refuses_wrong_shapes_of_tables) {
  EXPECT_EQ(faults("solve = 1"),
            "r.toml:1:9: solve = 1 (a table is wanted). Write [solve] on a line of its own and the keys below it");
  EXPECT_EQ(faults("[solve]\nmaterial = 1"),
            "r.toml:2:12: [solve] material = 1 (a table is wanted). Write [solve.material] on a line of its own and "
            "the keys below it");
  EXPECT_EQ(
      faults("[solve.release]\nname = \"A\""),
      "r.toml:1:1: [solve] release (a list of tables is wanted). Write [[solve.release]] above the keys of each one");
  EXPECT_EQ(faults("[[solve.release]]\nnmae = \"A\"\n[[solve.release]]\nthickness_m = -1"),
            "r.toml:2:1: unknown key \"nmae\" in [[solve.release]]. Did you mean \"name\"?\n"
            "r.toml:4:15: [[solve.release]] thickness_m = -1 (out of range). It must be >= 0");
}

TEST_F(RecipeFile, names_the_item_of_a_list_that_is_wrong) {
  EXPECT_EQ(faults("[solve]\ntimes_s = [1, -2, \"x\"]\npoints_per_cell = [2, 9, 2]"),
            "r.toml:2:15: [solve] times_s[1] = -2 (out of range). It must be >= 0\n"
            "r.toml:2:19: [solve] times_s[2] = \"x\" (it is text). Give a number\n"
            "r.toml:3:23: [solve] points_per_cell[1] = 9 (out of range). It must be 1 to 8");
}

TEST_F(RecipeFile, points_at_unknown_keys_and_scene_names_and_adds_what_the_options_themselves_check) {
  EXPECT_EQ(faults("[solv]\n"), "r.toml:1:2: unknown top-level table \"solv\". Did you mean \"solve\"?");
  EXPECT_EQ(
      faults("end = 3\n"),
      "r.toml:1:1: unknown top-level key \"end\". Known here: scene, preprocess, solve, postprocess, ensemble, slides, "
      "fit, calibrate");
  EXPECT_EQ(faults("[solve]\ndensity = 3"),
            "r.toml:2:1: unknown key \"density\" in [solve]. Did you mean \"density_kg_m3\"?");
  EXPECT_EQ(faults("[solve]\nfriction_angle_deg = 3"),
            "r.toml:2:1: unknown key \"friction_angle_deg\" in [solve]. It belongs in [solve.material]");
  EXPECT_EQ(faults("[solve.material]\nzzzzzzzz = 3"),
            "r.toml:2:1: unknown key \"zzzzzzzz\" in [solve.material]. Known here: friction_angle_deg, tension_pa");
  EXPECT_EQ(faults("[scene]\ntitel = \"x\""), "r.toml:2:1: unknown key \"titel\" in [scene]. Did you mean \"title\"?");
  EXPECT_EQ(faults("[scene]\nname = \"a/b\""),
            "r.toml:2:8: [scene] name = \"a/b\" (it becomes part of file names). Use letters, digits, '-', '_' and '.' "
            "only; put the rest into title");
  EXPECT_EQ(faults("[solve]\npoints_per_cell = [2]"),
            "[solve] points_per_cell (three numbers are wanted). Write [2, 2, 2]");
}

TEST_F(RecipeFile, says_where_a_file_is_not_toml_and_takes_letters_beyond_ascii_in_a_text) {
  EXPECT_TRUE(begins(faults("[solve]\nsteps = = 3\n"), "r.toml:2:9: this is not TOML ("));
  EXPECT_TRUE(begins(faults("[solve]\nsteps = 3\nsteps = 4\n"), "r.toml:3:"));
  const auto file = scratch.write("r.toml", "[scene]\nname = \"a\"\ntitle = \"\"\"Rutsch \\\n  über dem Dorf\"\"\"\n");
  EXPECT_EQ(Recipe(file).title(), "Rutsch über dem Dorf");
}

// toml++ alone leaves the paths its authors thought of here, which the sanitizer for undefined behaviour sees.
TEST_F(RecipeFile, refuses_letters_beyond_ascii_outside_of_quotes) {
  EXPECT_EQ(faults("[solve]\n# für\nsteps = 3 ö\n"),
            "r.toml:3:11: this is not TOML (Error while parsing key-value pair: expected a comment or whitespace, saw "
            "'ö'). Mend the line; the format is described on https://toml.io");
  for (const char* line : {"stéps = 3", "steps = 0\"hö\"", "steps = ö", "steps = 0[\"ö\"]", "steps = \"\"\"\\ö\"\"\""})
    EXPECT_TRUE(begins(faults(std::string("[solve]\n") + line + "\n"), "r.toml:2:")) << line;
}

TEST_F(RecipeFile, says_that_a_file_is_missing) {
  const auto missing = scratch / "none.toml";
  EXPECT_EQ(fault_of<RecipeError>([&] { Recipe r(missing); }),
            missing.string() + ": the recipe cannot be read (No such file or directory). Check the path");
  EXPECT_EQ(fault_of<RecipeError>([&] { Recipe r(scratch.folder()); }),
            scratch.folder().string() + ": the recipe cannot be read (it is a folder). Check the path");
}

TEST_F(RecipeFile, replaces_environment_variables_in_paths_and_leaves_names_inside_files_alone) {
  ::setenv("TALUS_TEST_DATA", "/data/frank", 1);
  EXPECT_EQ(read("[solve]\nterrain = \"${TALUS_TEST_DATA}/dem.tif\"").terrain, "/data/frank/dem.tif");
  ::setenv("TALUS_TEST_DATA", "sub", 1);
  EXPECT_EQ(read("[solve]\nterrain = \"${TALUS_TEST_DATA}/../dem.tif\"").terrain, scratch / "dem.tif");
  EXPECT_EQ(read("[solve]\nterrain = \"${TALUS_TEST_DATA}/../a.gpkg|subset=n = './${X}'\"").terrain,
            (scratch / "a.gpkg").string() + "|subset=n = './${X}'")
      << "a condition stays as it is";
  ::unsetenv("TALUS_TEST_DATA");
  EXPECT_EQ(faults("[solve]\nterrain = \"${TALUS_TEST_DATA}/dem.tif\""),
            "r.toml:2:11: [solve] terrain = \"${TALUS_TEST_DATA}/dem.tif\" (the environment variable TALUS_TEST_DATA "
            "is not set). Set it: export TALUS_TEST_DATA=...");
  EXPECT_EQ(read("[solve]\nterrain = \"NETCDF:dem.nc:z\"").terrain, "NETCDF:" + (scratch / "dem.nc").string() + ":z");
  EXPECT_EQ(read("[solve]\nterrain = \"\"").terrain, "");
}

TEST(Suggest, offers_only_what_is_near_by_edits) {
  EXPECT_EQ(recipe::edit_distance("", "abc"), 3u);
  EXPECT_EQ(recipe::edit_distance("steps", "steps"), 0u);
  EXPECT_EQ(recipe::edit_distance("setps", "steps"), 1u);  // a swap is one slip
  EXPECT_EQ(recipe::edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(recipe::nearest("spacin_m", {"spacing_m", "layer_height_m"}), "spacing_m");
  EXPECT_EQ(recipe::nearest("colour", {"spacing_m", "layer_height_m"}), "");
  EXPECT_EQ(recipe::did_you_mean("x", {}), "Remove it");
}

TEST_F(RecipeFile, refuses_what_a_key_needs_and_does_not_have_once_every_key_is_sound) {
  EXPECT_EQ(faults("[solve]\nsteps = 2\nverbose = true\nshape = \"linear\""), "");
  EXPECT_EQ(faults("[solve]\nverbose = true\nsteps = 1\nshape = \"cubic\""),
            "[solve] verbose = true with steps = 1 (there is nothing to tell). Take more steps, or leave verbose out\n"
            "[solve] shape = \"cubic\" with steps = 1 (it looks back two steps). Take shape = \"quadratic\"");
  EXPECT_EQ(faults("[solve]\ndensity_kg_m3 = 1e6\n[solve.material]\nfriction_angle_deg = 0.0"),
            "[solve.material] friction_angle_deg = 0 with so large a density (nothing would hold it). Raise it");
  EXPECT_EQ(faults("[[solve.release]]\nthickness_m = 1.0\n[[solve.release]]\nthickness_m = 1e3"),
            "[[solve.release]] number 2 (no release is so thick). Is it in metres?");
  EXPECT_EQ(faults("[solve]\nverbose = true\nsteps = 1\nlabel = 5"),
            "r.toml:4:9: [solve] label = 5 (it is an integer). Give text in quotes");
}

TEST_F(RecipeFile, names_no_old_key_and_no_need_in_template_and_used_recipe) {
  SampleOptions options;
  EXPECT_FALSE(test::holds(recipe::to_toml(options, "solve", true), {"friction_angle_rad"}));
  options.verbose = true;
  options.steps = 1;
  EXPECT_FALSE(test::holds(recipe::to_used_toml(options, "solve"), {"tell"}));
}

enum class Method { pcg, cholesky };

struct ImplicitTable {
  Method method = Method::pcg;
  void describe(recipe::Visitor& v) {
    recipe::choice(v, "linear_solver", method, {{"pcg", Method::pcg}, {"cholesky", Method::cholesky}}, "how");
  }
};

struct SolveTable {
  ImplicitTable implicit;
  void describe(recipe::Visitor& v) { recipe::table(v, "implicit", implicit, "implicit steps"); }
};

std::string faults(const std::string& text) {
  const test::Scratch scratch;
  return scratch.from_here(
      fault_of<RecipeError>([&] { recipe::Recipe(scratch.write("r.toml", text)).read<SolveTable>("solve"); }), "");
}

TEST(GoneKeys, are_refused_in_their_own_table_with_the_advice_on_them) {
  EXPECT_EQ(faults("[solve]\nflip_fraction = 0.99"),
            "r.toml:2:1: [solve] flip_fraction: no longer a key. Give transfer_time_s, the time over which velocity "
            "finer than the grid decays");
  EXPECT_EQ(
      faults("[solve.implicit]\nlinear_solver = \"bicgstab\""),
      "r.toml:2:17: [solve.implicit] linear_solver = \"bicgstab\" (no longer a choice). Take linear_solver = \"pcg\"");
  EXPECT_EQ(faults("[solve.implicit]\nflip_fraction = 0.99"),
            "r.toml:2:1: unknown key \"flip_fraction\" in [solve.implicit]. Known here: linear_solver");
  for (const char* key : {"solve.implicit", "solve.implicit.linear_solver=lu"})
    EXPECT_EQ(recipe::advice_on_gone(key), "") << key;
}

void expect_parts(const std::string& text, const VectorSource& parts) {
  const auto [file, layer, where] = vector_source(text);
  EXPECT_EQ(file, parts.file) << text;
  EXPECT_EQ(layer, parts.layer) << text;
  EXPECT_EQ(where, parts.where) << text;
  EXPECT_EQ(parts.text(), text);
}

TEST(VectorSource, layer_and_condition_may_be_left_out) {
  expect_parts("/a/b.gpkg", {.file = "/a/b.gpkg"});
  expect_parts("/a/b.gpkg|layername=c d", {.file = "/a/b.gpkg", .layer = "c d"});
  expect_parts("/a/b.gpkg|subset=id = 12", {.file = "/a/b.gpkg", .where = "id = 12"});
  expect_parts("/a/b.gpkg|layername=c|subset=id = 12", {.file = "/a/b.gpkg", .layer = "c", .where = "id = 12"});
  expect_parts("", {});
  // All behind the mark of a condition belongs to it.
  expect_parts("a.gpkg|subset=n = 'x/../|layername=y|subset=z'",
               {.file = "a.gpkg", .where = "n = 'x/../|layername=y|subset=z'"});
  expect_parts("a|b.gpkg", {.file = "a|b.gpkg"});
}

}  // namespace
}  // namespace talus
