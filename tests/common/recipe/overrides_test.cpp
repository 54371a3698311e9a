// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/overrides.hpp"

#include <gtest/gtest.h>

#include "common/recipe/recipe.hpp"
#include "common/stage/identity.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::SampleOptions;

struct Overrides : testing::Test {
  recipe::Recipe recipe(const std::vector<std::string>& set) {
    return recipe::Recipe(scratch.write("r.toml", text), set);
  }
  SampleOptions read(std::vector<std::string> set) { return recipe(std::move(set)).read<SampleOptions>("solve"); }
  std::string faults(std::vector<std::string> set) {
    std::string found = fault_of<RecipeError>([&] { read(std::move(set)); });
    const std::string folder = scratch.folder().string() + "/";
    for (std::size_t at; (at = found.find(folder)) != std::string::npos;) found.erase(at, folder.size());
    return found;
  }

  test::Scratch scratch;
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

TEST_F(Overrides, reach_items_of_lists_by_number) {
  const SampleOptions options =
      read({"solve.release[1].thickness_m=5", "solve.release[0].name=first", "solve.times_s[1]=9"});
  ASSERT_EQ(options.releases.size(), 2u);
  EXPECT_EQ(options.releases[0].name, "first");
  EXPECT_EQ(options.releases[0].thickness, 2);
  EXPECT_EQ(options.releases[1].name, "B");
  EXPECT_EQ(options.releases[1].thickness, 5);
  EXPECT_EQ(options.times, (std::vector<double>{1, 9}));
  EXPECT_EQ(read({"solve.release=[{name = \"C\"}]"}).releases.size(), 1u);
}

TEST_F(Overrides, the_last_of_several_values_holds) { EXPECT_EQ(read({"solve.steps=8", "solve.steps=9"}).steps, 9); }

TEST_F(Overrides, are_refused_with_the_words_of_the_recipe_and_their_own_place) {
  EXPECT_EQ(faults({"solve.steps=0"}), "--set solve.steps=0: [solve] steps = 0 (out of range). It must be 1 to 1000");
  EXPECT_EQ(faults({"solve.steps=many"}),
            "--set solve.steps=many: [solve] steps = \"many\" (it is text). Give an integer, without a decimal point");
  EXPECT_EQ(faults({"solve.densty_kg_m3=1"}),
            "--set solve.densty_kg_m3=1: unknown key \"densty_kg_m3\" in [solve]. Did you mean \"density_kg_m3\"?");
  EXPECT_EQ(faults({"solve.materal.friction_angle_deg=1"}),
            "--set solve.materal.friction_angle_deg=1: unknown key \"materal\" in [solve]. Did you mean \"material\"?");
  EXPECT_EQ(faults({"solv.steps=1"}), "--set solv.steps=1: unknown top-level table \"solv\". Did you mean \"solve\"?");
  EXPECT_EQ(faults({"solve.release[1].thickness_m=-1"}),
            "--set solve.release[1].thickness_m=-1: [[solve.release]] thickness_m = -1 (out of range). It must be >= "
            "0");
}

TEST_F(Overrides, that_lead_nowhere_are_refused_all_at_once) {
  const char* const form = "Write --set key=value, the key with its tables: --set solve.end_time_s=60";
  EXPECT_EQ(faults({"solve.steps"}), std::string("--set solve.steps (there is no value). ") + form);
  EXPECT_EQ(faults({"solve..steps=1", "=1", "solve.=1"}), std::string("--set solve..steps=1 (this is no key). ") +
                                                              form + "\n--set =1 (this is no key). " + form +
                                                              "\n--set solve.=1 (this is no key). " + form);
  EXPECT_EQ(faults({"solve.release[x].name=1"}),
            "--set solve.release[x].name=1 (this is no key). Give the number of an item, counted from 0: --set "
            "'solve.part[0].release=A'");
  EXPECT_EQ(faults({"solve.release[2].name=C"}),
            "--set solve.release[2].name=C (solve.release has 2 items, counted from 0). Name one that is there, or add "
            "it to the recipe");
  EXPECT_EQ(faults({"solve.part[0].name=C"}),
            "--set solve.part[0].name=C (the recipe has no list solve.part). Give the whole list: --set "
            "'solve.part=[...]'");
  EXPECT_EQ(faults({"solve.steps[0]=1"}), "--set solve.steps[0]=1 (solve.steps is no list). Leave the [] out");
  EXPECT_EQ(faults({"solve.steps.x=1"}),
            "--set solve.steps.x=1 (solve.steps is no table). Leave out what comes behind it");
  EXPECT_EQ(faults({"solve.release.name=A"}),
            "--set solve.release.name=A (solve.release is a list). Name one of its items, counted from 0: "
            "solve.release[0]");
  EXPECT_NE(faults({"solve.times_s=[1, 2"}).find("--set solve.times_s=[1, 2 (the value is not TOML: "),
            std::string::npos);
}

TEST_F(Overrides, belong_to_their_recipe_alone) {
  const recipe::Recipe changed = recipe({"solve.steps=8"}), plain = recipe({});
  EXPECT_EQ(changed.overrides(), std::vector<std::string>{"solve.steps=8"});
  EXPECT_EQ(changed.with({"solve.verbose=true"}).overrides(), changed.overrides());
  EXPECT_TRUE(plain.overrides().empty());
  EXPECT_EQ(plain.read<SampleOptions>("solve").steps, 7);
}

/// What is said on the command line makes what was computed with other values stale, as the recipe's file does.
TEST_F(Overrides, change_the_mark_of_their_table_as_the_file_would) {
  const std::string plain = recipe_mark(recipe({}), "solve"), set = recipe_mark(recipe({"solve.steps=8"}), "solve");
  EXPECT_NE(set, plain);
  text.replace(text.find("steps = 7"), 9, "steps = 8");
  EXPECT_EQ(recipe_mark(recipe({}), "solve"), set);
}

}  // namespace
}  // namespace talus
