// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as checkpoint.h5, sealed as anybody can: lists of one length, or refused in words.
#include "solver/run/recorders/checkpoint.hpp"
#include "common/run/hdf5.hpp"
#include "tests/fuzz/target.hpp"

TALUS_FUZZ_TARGET(checkpoint) {
  const talus::fuzz::InputFile file(bytes, ".h5");
  file.seal();
  talus::fuzz::expect_result_or_error([&] {
    const std::string fingerprint = talus::h5::File::open(file.path(), {file.path(), ""}).text("/", "fingerprint");
    const auto checkpoint = talus::solver::read_checkpoint(file.path(), fingerprint);
    if (checkpoint.state.points.velocity[0].size() != checkpoint.state.points.size())
      throw std::logic_error("points of different lengths");
  });
}
