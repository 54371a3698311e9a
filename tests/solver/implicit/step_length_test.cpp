// The length of implicit steps: over events, after cuts.
#include "solver/implicit/step_length.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(StepLength, never_steps_over_an_event) {
  const StepLength length(1);
  EXPECT_EQ(length.next(10), 1);
  EXPECT_EQ(length.next(1.5), 0.75) << "two even steps rather than a full one and a sliver";
  EXPECT_EQ(length.next(0.5), 0.5);
  EXPECT_EQ(length.next(1 + 1e-12), 1 + 1e-12);
}

TEST(StepLength, grows_back_after_cuts) {
  StepLength length(1);
  EXPECT_EQ(length.halve(1), 0.5);
  EXPECT_EQ(length.halve(0.5), 0.25);
  EXPECT_EQ(length.next(10), 0.25);
  length.grow();
  EXPECT_EQ(length.next(10), 0.375);
  for (int i = 0; i < 9; ++i) length.grow();
  EXPECT_EQ(length.next(10), 1);
}

}  // namespace
}  // namespace talus::solver::testing
