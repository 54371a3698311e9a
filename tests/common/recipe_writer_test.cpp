#include <gtest/gtest.h>

#include <limits>

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
  options.friction = 35;
  options.tension = 0;
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

}  // namespace
}  // namespace talus
