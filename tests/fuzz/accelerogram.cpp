// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as an accelerogram: samples later and later with finite velocities, or refused by line.
#include "solver/scene/read_shaking.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(accelerogram) {
  using namespace talus::solver;
  const talus::fuzz::InputFile file(bytes, ".csv");
  talus::fuzz::expect_result_or_error([&] {
    const Shaking shaking =
        read_shaking({.file = file.path(), .azimuth = bytes.size() % 2 == 0 ? std::optional(30.0) : std::nullopt});
    for (std::size_t n = 1; n < shaking.samples.size(); ++n) {
      if (!(shaking.samples[n].time > shaking.samples[n - 1].time) ||
          !std::isfinite(talus::length(shaking.samples[n].velocity)))
        throw std::logic_error("samples that are none");
    }
  });
}
