// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points of elastic bodies that are stretched far: counted at every record, and said at the end.
#include "solver/run/recorders/stretch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/run/recorders/history.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// What is said of a block of a law, eight of its points stretched along x by this factor, less as much across, where
/// the recipe bears that they part.
std::vector<Finding> found_of(MaterialModel model, double stretch, RunHistory* rows = nullptr,
                              const std::vector<std::string>& accept = {torn_body}) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 8, 4, 8, 0, 2});
  SolveOptions o;
  o.material.model = model;
  o.accept = accept;
  Scene scene = make_scene(d, o);
  for (std::size_t p = 0; p < 8; ++p) {
    scene.points.elastic[0][p] = std::log(stretch);
    scene.points.elastic[2][p] = -std::log(stretch);
  }
  History history(o, scene);
  const auto solver = solver::make_solver(scene, o, make_device(On::cpu));
  const RunMemory counted;
  history.record({.time = 0,
                  .clock = solver->clock(),
                  .energies = solver->energies(),
                  .step_over_cfl = 0,
                  .counted = counted,
                  .solver = *solver});
  if (rows) *rows = history.rows();
  return test::findings_of([&] { history.conclude(); }, accept);
}

TEST(StretchRecorder, names_the_points_that_hencky_tears_and_the_law_that_does_not) {
  RunHistory rows;
  const auto lines = found_of(MaterialModel::hencky, 3, &rows);
  ASSERT_EQ(lines.size(), 3u);
  for (const char* words : {"8 points", "factor of up to 3.", "e = 2.72", "neo-hookean"})
    EXPECT_NE(lines[0].message.find(words), std::string::npos) << words << "\n" << lines[0].message;
  EXPECT_EQ(rows.at("overstretched_points").values, std::vector<double>{8});
  EXPECT_NEAR(rows.at("largest_stretch").values[0], 3, 1e-12);
}

/// Two points along a cell, 0.65 of a cell apart at a stretch of 1.3.
TEST(StretchRecorder, names_the_points_of_any_elastic_body_that_lie_far_apart) {
  for (const auto model : {MaterialModel::hencky, MaterialModel::neo_hookean, MaterialModel::corotated}) {
    RunHistory rows;
    const auto lines = found_of(model, 1.35, &rows);
    ASSERT_EQ(lines.size(), 2u);
    for (const char* words : {"8 points", "factor of up to 1.35", "0.65 of a cell", "gimp"})
      EXPECT_NE(lines[0].message.find(words), std::string::npos) << words << "\n" << lines[0].message;
    EXPECT_EQ(rows.at("points_apart").values, std::vector<double>{8});
    EXPECT_TRUE(found_of(model, 1.25).empty());
  }
}

TEST(StretchRecorder, ends_a_run_whose_body_may_have_parted_unless_that_is_accepted) {
  try {
    found_of(MaterialModel::neo_hookean, 1.35, nullptr, {});
    FAIL() << "a torn body was borne";
  } catch (const NumericalError& error) {
    const std::string words = error.what();
    for (const char* part : {"8 points", "factor of up to 1.35", "0.65 of a cell", "gimp", "accept = [\"torn-body\"]"})
      EXPECT_NE(words.find(part), std::string::npos) << part << "\n" << words;
  }
  EXPECT_TRUE(found_of(MaterialModel::neo_hookean, 1.25, nullptr, {}).empty());
}

TEST(StretchRecorder, leaves_what_was_insisted_on_with_the_results) {
  const auto found = found_of(MaterialModel::neo_hookean, 1.35);
  ASSERT_TRUE(is_accepted(found, torn_body));
  for (const char* part : {"8 points", "factor of up to 1.35", "0.65 of a cell"})
    EXPECT_NE(accepted_line(found).find(part), std::string::npos) << part << "\n" << accepted_line(found);
  EXPECT_TRUE(found_of(MaterialModel::neo_hookean, 1.25).empty()) << "nothing was torn";
}

TEST(StretchRecorder, is_silent_of_what_flows) {
  RunHistory rows;
  EXPECT_TRUE(found_of(MaterialModel::drucker_prager, 3, &rows).empty());
  EXPECT_EQ(rows.find("overstretched_points"), nullptr) << "other laws do not pay for it";
}

}  // namespace
}  // namespace talus::solver::testing
