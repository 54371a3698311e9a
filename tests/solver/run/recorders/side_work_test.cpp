// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work beside the run: in order, and its errors reach who waits for it.
#include "solver/run/recorders/side_work.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace talus::solver {
namespace {

TEST(side_work, pieces_are_done_one_after_the_other) {
  std::string done;
  SideWork work;
  for (const char* piece : {"a", "b", "c"}) work.start([&done, piece] { done += piece; });
  work.settle();
  EXPECT_EQ(done, "abc");
}

TEST(side_work, an_error_is_thrown_where_the_next_piece_is_started) {
  SideWork work;
  bool ran = false;
  work.start([] { throw std::runtime_error("disk"); });
  EXPECT_THROW(work.start([&ran] { ran = true; }), std::runtime_error);
  work.settle();
  EXPECT_FALSE(ran);
}

TEST(side_work, an_error_is_thrown_where_it_is_waited_for) {
  SideWork work;
  work.start([] { throw std::runtime_error("disk"); });
  EXPECT_THROW(work.settle(), std::runtime_error);
  work.settle();  // and only once
}

}  // namespace
}  // namespace talus::solver
