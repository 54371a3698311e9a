// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// cuSOLVER is loaded when it is first used, as a whole or not at all.
#include "solver/linear/direct/cusolver.hpp"

#include <gtest/gtest.h>

#include <string>

#include "common/error.hpp"

namespace talus {
namespace {

TEST(Cusolver, is_loaded_as_a_whole_or_says_what_to_install) {
  try {
    const Cusolver& library = cusolver();
    EXPECT_NE(library.create, nullptr);
    EXPECT_NE(library.order_by_dissection, nullptr);
    EXPECT_NE(library.factorise, nullptr);
    EXPECT_NE(library.solve, nullptr);
    EXPECT_EQ(&cusolver(), &library) << "loaded once";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("Install NVIDIA's libcusolver"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace talus
