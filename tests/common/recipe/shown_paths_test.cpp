// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Paths in messages as the user wrote them, and none that is absolute in what is sent on.
#include "common/recipe/shown_paths.hpp"

#include <gtest/gtest.h>

#include "common/recipe/recipe.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

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
