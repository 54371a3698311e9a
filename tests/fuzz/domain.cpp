// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as domain.vdb, sealed as anybody can: a domain whose points lie on its map, or refused.
#include "common/domain/domain.hpp"

#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(domain) {
  const talus::fuzz::InputFile file(bytes, ".vdb");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    const talus::Domain domain = talus::read_domain(file.path());
    if (domain.terrain.values.size() != domain.grid.count()) throw std::logic_error("a map of another size");
  });
}
