// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as run.h5, sealed as anybody can: read, or refused in words.
#include "common/run/motion.hpp"
#include "common/run/run_file.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(run) {
  const talus::fuzz::InputFile file(bytes, ".h5");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    const talus::Run run = talus::read_run(file.path());
    if (run.maps.terrain.size() != run.maps.grid.count()) throw std::logic_error("a map of another size");
    talus::read_motion(file.path(), 1);
  });
}
