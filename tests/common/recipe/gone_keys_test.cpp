// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Keys, tables and choices of earlier versions are refused with the advice on them.
#include "common/recipe/gone_keys.hpp"

#include <gtest/gtest.h>

#include "common/recipe/recipe.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

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
  std::string found =
      test::fault_of<RecipeError>([&] { recipe::Recipe(scratch.write("r.toml", text)).read<SolveTable>("solve"); });
  const std::string folder = scratch.folder().string() + "/";
  for (std::size_t at; (at = found.find(folder)) != std::string::npos;) found.erase(at, folder.size());
  return found;
}

TEST(GoneKeys, a_key_is_refused_with_the_advice_on_it) {
  EXPECT_EQ(faults("[solve]\nflip_fraction = 0.99"),
            "r.toml:2:1: [solve] flip_fraction: no longer a key. Give transfer_time_s, the time over which velocity "
            "finer than the grid decays");
}

TEST(GoneKeys, a_word_of_a_choice_is_refused_with_the_advice_on_it) {
  EXPECT_EQ(faults("[solve.implicit]\nlinear_solver = \"bicgstab\""),
            "r.toml:2:17: [solve.implicit] linear_solver = \"bicgstab\" (no longer a choice). Take linear_solver = "
            "\"pcg\"");
}

TEST(GoneKeys, a_key_is_gone_in_its_own_table_only) {
  EXPECT_EQ(faults("[solve.implicit]\nflip_fraction = 0.99"),
            "r.toml:2:1: unknown key \"flip_fraction\" in [solve.implicit]. Known here: linear_solver");
}

TEST(GoneKeys, there_is_no_advice_on_other_keys) {
  EXPECT_EQ(recipe::advice_on_gone("solve.implicit"), "");
  EXPECT_EQ(recipe::advice_on_gone("solve.implicit.linear_solver=lu"), "");
}

}  // namespace
}  // namespace talus
