// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/names.hpp"

#include <gtest/gtest.h>

#include "tests/common/damage.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"

namespace talus {
namespace {

TEST(EnsemblePaths, find_the_counts_of_all_members_before_those_of_parts) {
  const test::Scratch scratch;
  const EnsemblePaths paths{scratch.folder()};
  EXPECT_TRUE(paths.found_counts().empty());
  for (const char* name : {"counts.100-200.h5", "counts.20-100.h5", "counts.0-20.h5", "counts.x-3.h5", "counts.5.h5"})
    scratch.write(name, "");
  const std::vector<std::filesystem::path> parts{scratch / "counts.0-20.h5", scratch / "counts.20-100.h5",
                                                 scratch / "counts.100-200.h5"};
  EXPECT_EQ(paths.found_counts(), parts) << "by their members, not by their letters";
  scratch.write("counts.h5", "");
  EXPECT_EQ(paths.found_counts(), std::vector<std::filesystem::path>{scratch / "counts.h5"});
}

}  // namespace
}  // namespace talus
