// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as counts.h5 of an ensemble, sealed by whoever changed them: read, or refused in words.
#include "common/ensemble/counts.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(counts) {
  const talus::fuzz::InputFile file(bytes, ".h5");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    const talus::EnsembleCounts counts = talus::read_counts(file.path());
    if (counts.states.size() != static_cast<std::size_t>(counts.part.count()))
      throw std::logic_error("states of other members");
  });
}
