// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What was used of a recipe is a recipe of the same: of the project's scenes, and of the stages' templates.
#include <cstdlib>

#include "common/recipe/recipe.hpp"
#include "talus/commands.hpp"
#include "tests/common/scratch.hpp"
#include "tests/places.hpp"

namespace talus::command {
namespace {

namespace fs = std::filesystem;

std::string with_scene(const std::string& tables) { return "[scene]\nname = \"used\"\n\n" + tables; }

/// The tables of a stage as it uses them, read from a text in a folder of its own.
std::string used_of(const std::string& text, const std::string& stage) {
  const test::Scratch elsewhere;
  return stage_called(stage).used_toml(recipe::Recipe(elsewhere.write("recipe.toml", text)));
}

struct UsedRecipe : testing::Test {
  UsedRecipe() {
    for (const char* name : {"TALUS_DATA", "TALUS_RESULTS"}) ::setenv(name, "/somewhere", 1);
  }
};

TEST_F(UsedRecipe, of_every_scene_says_the_same_again) {
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TALUS_SOURCE_DIR) / "pipelines")) {
    if (entry.path().extension() != ".toml") continue;
    const recipe::Recipe recipe(entry.path());
    for (const char* stage : stage_names) {
      if (!recipe.canonical(stage)) continue;
      const std::string used = stage_called(stage).used_toml(recipe);
      EXPECT_EQ(used_of(with_scene(used), stage), used) << entry.path() << ", " << stage;
      ++scenes;
    }
  }
  EXPECT_GT(scenes, 40);
}

TEST_F(UsedRecipe, of_every_template_says_the_same_again) {
  for (const std::string stage : {"solve", "postprocess"}) {
    const std::string used = used_of(with_scene(stage_called(stage).template_toml()), stage);
    EXPECT_EQ(used_of(with_scene(used), stage), used) << stage;
  }
  std::string scene = stage_called("preprocess").template_toml();
  for (const std::string key : {"before_dem = ", "after_dem = "})
    scene.replace(scene.find("\n" + key + "\"\"") + 1, key.size() + 2, key + "\"/somewhere/dem.tif\"");
  const std::string used = used_of(with_scene(scene), "preprocess");
  EXPECT_EQ(used_of(with_scene(used), "preprocess"), used);
}

}  // namespace
}  // namespace talus::command
