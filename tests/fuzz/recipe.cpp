// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a recipe: read with a key of every kind, or refused in words.
#include "tests/common/sample_options.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(recipe) {
  const talus::fuzz::InputFile file(bytes, ".toml");
  talus::fuzz::expect_result_or_error([&] {
    const talus::recipe::Recipe recipe(file.path());
    const auto options = recipe.read<talus::test::SampleOptions>("solve");
    talus::recipe::to_toml(options, "solve", false);
  });
}
