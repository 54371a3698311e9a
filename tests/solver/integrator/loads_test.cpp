#include "solver/integrator/loads.hpp"

#include <gtest/gtest.h>

namespace talus::solver {
namespace {

TEST(Loads, grow_over_their_ramp_and_end) {
  const std::vector<Load> loads{{.force = {8, -4, 2}, .ramp = 4, .from = 1, .to = 10},
                                {.force = {0, 0, 6}, .ramp = 0, .from = 0, .to = 2}};
  const std::vector<double> volumes{2, 3};
  const auto at = [&](double time) { return load_densities(loads, volumes, time); };
  EXPECT_EQ(at(0)[0].x, 0);
  EXPECT_EQ(at(0)[1].z, 2);
  EXPECT_EQ(at(3)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(at(3)[0].y, -1);
  EXPECT_EQ(at(3)[1].z, 0);
  EXPECT_EQ(at(7)[0].z, 1);
  EXPECT_EQ(at(10)[0].x, 0);
  EXPECT_TRUE(load_densities(loads, {}, 3).empty());
}

}  // namespace
}  // namespace talus::solver
