// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The main() of these tests: like those of the programs it can be started for a reading (child_reading.hpp).
#include <gtest/gtest.h>

#include "common/stage/child_reading.hpp"

int main(int argc, char** argv) {
  talus::serve_child_reading(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
