// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a level set of another program: a surface of finite facets, or refused in words.
#include "common/domain/level_set.hpp"

#include <cmath>

#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(level_set) {
  const talus::fuzz::InputFile file(bytes, ".vdb");
  talus::fuzz::expect_result_or_error([&] {
    const talus::BodySurface surface = talus::read_level_set(file.path(), "", {1, 1, 1});
    if (!std::isfinite(surface.volume)) throw std::logic_error("a body without a volume");
  });
}
