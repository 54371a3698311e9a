// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the keys of [[solve.inflow]] need of one another and of the rest.
#include "solver/options/inflow.hpp"

#include "solver/options/solve.hpp"
#include "tests/common/scratch.hpp"

namespace talus::solver {
namespace {

const std::string line = "line_m = [[0.0, 5.0], [10.0, 5.0]]\n";
const std::string rows = "hydrograph = [[0.0, 3.0], [60.0, 0.0]]\n";

/// What a recipe with these lines in [solve] and in [[solve.inflow]] is refused with; empty where it is sound.
std::string inflow_faults(const std::string& inflow, const std::string& solve = "") {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("r.toml", "[solve]\n" + solve + "\n[[solve.inflow]]\n" + inflow));
  return test::fault_of<RecipeError>([&] { recipe.read<SolveOptions>("solve"); });
}

void expect_words(const std::string& fault, const std::string& words) {
  EXPECT_NE(fault.find(words), std::string::npos) << fault;
}

TEST(InflowOptions, take_a_line_a_hydrograph_and_one_of_speed_depth_and_froude_number) {
  for (const char* one : {"speed_m_s = 4.0", "depth_m = 1.0", "froude = 1.1"})
    EXPECT_EQ(inflow_faults(line + rows + one), "");
  EXPECT_EQ(inflow_faults(line + "file = \"q.csv\"\nspeed_m_s = 4.0"), "");
  expect_words(inflow_faults(line + rows), "0 of speed_m_s, depth_m and froude are given");
  expect_words(inflow_faults(line + rows + "speed_m_s = 4.0\nfroude = 1.0"), "2 of speed_m_s");
  expect_words(inflow_faults(rows + "froude = 1.0"), "line_m has 0 points");
  expect_words(inflow_faults("line_m = [[1.0, 5.0], [1.0, 5.0]]\n" + rows + "froude = 1.0"), "one point");
}

TEST(InflowOptions, refuse_rows_that_are_no_hydrograph) {
  const std::string rest = line + "froude = 1.0\n";
  expect_words(inflow_faults(rest), "neither file nor hydrograph");
  expect_words(inflow_faults(rest + rows + "file = \"q.csv\""), "file beside hydrograph");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0, 2.0], [5.0, 3.0]]"), "5 before 5");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0]]"),
               "hydrograph[1] (a row of two numbers is wanted)");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0]]"), "has one row");
  expect_words(inflow_faults(rest + "hydrograph = [[0.0, 1.0], [5.0, -2.0]]"), "hydrograph[1][1] = -2");
}

TEST(InflowOptions, go_with_every_integrator_that_has_inertia) {
  const std::string inflow = line + rows + "froude = 1.0\n";
  for (const char* integrator : {"explicit", "column-implicit", "newmark", "auto"})
    EXPECT_EQ(inflow_faults(inflow, std::string("integrator = \"") + integrator + "\""), "");
  expect_words(inflow_faults(inflow, "integrator = \"quasi-static\""), "does not go with integrator");
}

TEST(InflowOptions, are_called_by_their_number_or_a_name_that_is_theirs_alone) {
  InflowOptions o;
  EXPECT_EQ(inflow_name(o, 1), "inflow-2");
  o.name = "gully";
  EXPECT_EQ(inflow_name(o, 1), "gully");
  const std::string one = "name = \"a\"\n" + line + rows + "froude = 1.0\n";
  expect_words(inflow_faults(one + "[[solve.inflow]]\n" + one), "\"a\" is given twice");
}

}  // namespace
}  // namespace talus::solver
