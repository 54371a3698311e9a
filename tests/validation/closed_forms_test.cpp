// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The closed forms against values from elsewhere, so that the table leans on something; and the table.
#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/common/scratch.hpp"
#include "tests/validation/closed_forms.hpp"
#include "tests/validation/report.hpp"
#include "tests/validation/slices.hpp"

namespace talus::validation {
namespace {

TEST(closed_forms, elastica_has_the_tabulated_tips) {
  // Mattiasson 1981, table 1: k, w/L, u/L.
  const double table[][3] = {{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064},  {5, 0.71379, 0.38763},
                             {8, 0.78498, 0.50483}, {10, 0.81061, 0.55500}, {3.6, 0.64684, 0.30128}};
  for (const auto& [k, w, u] : table) {
    EXPECT_NEAR(elastica(k).across, w, 1e-5) << "k = " << k;
    EXPECT_NEAR(elastica(k).along, u, 1e-5) << "k = " << k;
  }
}

TEST(closed_forms, solid_beam_is_the_elastica_where_it_is_slender) {
  for (const Law law : {Law::hencky, Law::corotated})
    EXPECT_NEAR(solid_beam(5, 1e-3, law).across, elastica(5).across, 1e-5);
}

TEST(closed_forms, solid_beam_adds_timoshenkos_shear_to_a_small_deflection) {
  // w = k/3 + P L / (5/6 G A) with P = k E I.
  constexpr double k = 1e-3, depth = 0.1;
  EXPECT_NEAR(solid_beam(k, depth, Law::corotated).across / (k / 3 + k * depth * depth / 12 * 12 / 5), 1, 1e-5);
}

TEST(closed_forms, axis_of_the_beam_runs_from_clamp_to_tip) {
  AxisPoint axis[11];
  const Tip tip = solid_beam(4, 0.1, Law::hencky, axis, 11);
  EXPECT_EQ(axis[0].x, 0);
  EXPECT_NEAR(axis[10].w, tip.across, 1e-12);
  EXPECT_NEAR(axis[10].x, 1 - tip.along, 1e-12);
}

TEST(closed_forms, stress_and_stretch_invert_each_other) {
  for (const Law law : {Law::hencky, Law::corotated}) {
    for (const double stretch : {0.2, 0.7, 0.99, 1.01, 1.5}) {
      const double piola = piola_of_stretch(law, stretch);
      EXPECT_NEAR(stretch_of_piola(law, piola), stretch, 1e-12);
      if (stretch > 0.6) {  // where the corotated Kirchhoff stress grows with the stretch
        EXPECT_NEAR(piola_of_kirchhoff(law, piola * stretch), piola, 1e-12);
      }
    }
  }
}

TEST(closed_forms, column_settles_as_linear_theory_says_where_it_is_stiff) {
  // w H^2 / (2 E), with hencky less its largest strain.
  const Column hencky{Law::hencky, 1e8, 200, 50}, corotated{Law::corotated, 1e8, 200, 50};
  EXPECT_NEAR(hencky.settlement(50) / 0.0025, 1 - 1e-4, 1e-7);
  EXPECT_NEAR(corotated.settlement(50) / 0.0025, 1, 1e-12);
  EXPECT_EQ(hencky.piola(0), -1e4);
}

TEST(closed_forms, column_has_the_papers_stress_in_current_coordinates) {
  // sigma(x) = E (sqrt(2 rho b (D - x) / E + 1) - 1), tension positive and b upwards; the weight presses, so b < 0.
  const Column c{Law::corotated, 1e6, 200, 50};
  const double top = 50 - c.settlement(50);
  for (const double x : {0.0, 10.0, 30.0, 49.0}) {
    const double now = x - c.settlement(x);
    EXPECT_NEAR(1e6 * (std::sqrt(-2 * 200 * (top - now) / 1e6 + 1) - 1), c.piola(x), 1e-6);
  }
}

TEST(closed_forms, block_slides_as_newton_says) {
  const SlidingBlock coulomb{0.5, 0.3, 0.3};
  EXPECT_NEAR(coulomb.way(1, 2), 2 + 0.5 * 9.81 * (std::sin(0.5) - 0.3 * std::cos(0.5)) * 4, 1e-9);
}

TEST(closed_forms, ground_line_takes_its_share_in_a_tight_bend) {
  // In a bend much shorter than the way, friction on the centripetal force leaves exp(-2 mu angle) of v^2.
  const GroundLine line{GroundLine::bend, 1000, 0, 1};
  const double slope = M_PI / 6, mu = 0.4, foot = 1000 / std::tan(slope), start = 400;
  const double square = 2 * 9.81 * (std::sin(slope) - mu * std::cos(slope)) * (foot - start) / std::cos(slope);
  const double way = square * std::exp(-2 * mu * slope) / (2 * mu * 9.81);
  EXPECT_NEAR(line.reach(start, mu) / (foot + way), 1, 2e-3);  // what a bend of 1 m is not tight by
  EXPECT_NEAR(line.elevation(start), (foot - start) * std::tan(slope), 1e-9);
  EXPECT_EQ(line.elevation(foot + 10), 0);
  // On a parabola the drop over the way exceeds mu by what the bend takes.
  const GroundLine parabola{GroundLine::parabola, 1000, 2250, 0};
  const double end = parabola.reach(start, mu),
               drop = (parabola.elevation(start) - parabola.elevation(end)) / (end - start);
  EXPECT_GT(drop, mu);
  EXPECT_LT(drop, 1.3 * mu);
  EXPECT_EQ(parabola.reach(2000, mu), 2000);  // too gentle to start
}

TEST(closed_forms, parabolic_cap_spreads_by_its_own_pressure) {
  const ParabolicCap cap{0.6, 0.4, 4, 80};
  const double t = 5, dt = 1e-3;
  const auto before = cap.at(t - dt), now = cap.at(t), after = cap.at(t + dt);
  EXPECT_NEAR((after.width - 2 * now.width + before.width) / (dt * dt),
              2 * 9.81 * std::cos(0.6) * 4 / (6400 * std::pow(now.width, 3)), 1e-6);
  EXPECT_NEAR((after.width - before.width) / (2 * dt), now.spread, 1e-8);
  EXPECT_NEAR((after.way - before.way) / (2 * dt), now.speed, 1e-9);
  double volume = 0;
  for (int i = -400; i < 400; ++i)
    for (int j = -400; j < 400; ++j) volume += 0.25 * cap.thickness(now, 0.5 * i, 0.5 * j);
  EXPECT_NEAR(volume, 0.5 * M_PI * 6400 * 4, 1e-4 * volume);
}

TEST(closed_forms, dam_break_keeps_its_volume_and_momentum_balance) {
  const DamBreak dam{0.4, 0.35, 1.5};
  const double pull = 9.81 * (std::sin(0.4) - std::cos(0.4) * std::tan(0.35)), dx = 1e-3;
  double volume = 0, momentum = 0;
  for (int n = 0; n < 120'000; ++n) {
    const double x = -40 + (n + 0.5) * dx;
    volume += dx * dam.thickness(x, 3);
    momentum += dx * dam.thickness(x, 3) * dam.speed(x, 3);
  }
  // What came in over x = -40; weight less friction, the momentum of the inflow and the pressure at x = -40.
  EXPECT_NEAR(volume, 40 * 1.5 + 0.5 * pull * 9 * 1.5, 1e-3);
  double impulse = 0;
  const double dt = 1e-3;
  for (int n = 0; n < 3000; ++n) {
    const double t = (n + 0.5) * dt, speed = pull * t, mass = 40 * 1.5 + 0.5 * pull * t * t * 1.5;
    impulse += dt * (mass * pull + 1.5 * speed * speed + 0.5 * 9.81 * std::cos(0.4) * 1.5 * 1.5);
  }
  EXPECT_NEAR(momentum, impulse, 1e-3 * impulse);
}

TEST(closed_forms, order_is_the_slope_in_logarithms) {
  const double x[] = {1, 0.5, 0.25}, y[] = {3, 0.75, 0.1875};
  EXPECT_NEAR(observed_order(x, y, 3), 2, 1e-12);
}

TEST(recipe_text, overrides_keys_and_adds_tables) {
  test::Scratch scratch;
  const auto base = scratch.write("recipe.toml", "[a]\nx = 1.0\n[[b]]\nname = \"one\"\n");
  const std::string text = recipe_with(base, {{"a.x", 2.5},
                                              {"a.c.y", whole(3)},
                                              {"b[0].name", words("first")},
                                              {"b[1].name", words("second")},
                                              {"a.list", std::vector<double>{0, 0.5, 0.0225}}});
  for (const char* part : {"x = 2.5", "y = 3", "name = 'first'", "name = 'second'", "list = [ 0.0, 0.5, 0.0225 ]"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  EXPECT_THROW(recipe_with(base, {{"b[5].name", words("far")}}), std::runtime_error);
}

TEST(sand_laws, give_the_column_of_the_reference_paper) {
  EXPECT_NEAR(0.09 * (1 + lube_run_out(7)), 0.8145, 1e-4);
  EXPECT_NEAR(0.09 * lube_height(7), 0.196, 1e-4);
  EXPECT_NEAR(0.09 * (1 + lajeunesse_run_out(7)), 0.716, 1e-3);
}

TEST(sand_laws, have_a_band_where_one_of_them_is_silent) {
  EXPECT_TRUE(std::isnan(lube_run_out(2)));
  const Band band = band_of(lube_run_out(2), lajeunesse_run_out(2));
  EXPECT_DOUBLE_EQ(band.low, 0.9 * 2.4);
  EXPECT_DOUBLE_EQ(band.high, 1.1 * 2.4);
}

TEST(sand_laws, band_holds_both_laws) {
  for (const double a : {0.5, 1.0, 1.5, 3.0, 5.0, 9.0}) {
    const Band band = band_of(lube_run_out(a), lajeunesse_run_out(a));
    EXPECT_LT(band.low, lajeunesse_run_out(a));
    EXPECT_GT(band.high, lube_run_out(a));
  }
}

TEST(slices, have_the_factor_of_bishop_and_morgensterns_chart) {
  // 1960: 2:1, phi = 20 deg, c = 0.05, firm base at the toe; 1.380 by their charts (in Griffiths & Lane 1999).
  EXPECT_NEAR(bishop_factor({.cohesion = 0.05, .friction = 20}), 1.380, 0.004);
}

TEST(slices, have_taylors_factor_of_clay) {
  // 1937: 2:1, phi = 0, c = 0.25, firm base one height below the toe; 1.47 (in Griffiths & Lane 1999).
  EXPECT_NEAR(bishop_factor({.cohesion = 0.25, .base = 2}), 1.47, 0.005);
}

TEST(slices, go_through_the_toe_above_a_foundation_of_the_same_ground) {
  // Griffiths & Lane 1999, example 2: circles may dip below the toe, which changes little; those on its base have 1.75.
  const double deep = bishop_factor({.cohesion = 0.05, .friction = 20, .base = 1.5});
  EXPECT_LT(deep, bishop_factor({.cohesion = 0.05, .friction = 20}));
  EXPECT_NEAR(deep, 1.37, 0.01);
}

TEST(slices, lose_as_much_as_the_water_carries) {
  // F falls linearly with r_u (Bishop & Morgenstern 1960), as long as the circle stays where it is.
  const auto factor = [](double water) { return bishop_factor({.cohesion = 0.05, .friction = 20, .water = water}); };
  const double dry = factor(0), first = dry - factor(0.25), second = factor(0.25) - factor(0.5);
  EXPECT_GT(first, 0.2);
  EXPECT_NEAR(first, second, 0.02);
}

/// The rows that a case makes of a run which went well, or ended with a fault.
std::vector<Row> rows_of(const std::string& fault, const std::function<void(Bench&, const Outcome&)>& judge) {
  std::vector<Row> rows;
  const Request request;
  Bench bench("X1", request, [&](const Row& row) { rows.push_back(row); });
  Outcome outcome;
  outcome.variant = "some grid";
  outcome.fault = fault;
  judge(bench, outcome);
  return rows;
}

/// A row that is met, one that misses, and one that claims nothing.
void three_rows(Bench& bench, const Outcome& o) {
  bench.compare(o, "way", 1.005, 1, 0.01);
  bench.compare(o, "height", 1.05, 1, 0.01);
  bench.note(o, "speed", 3);
}

nlohmann::json json_of(const std::vector<Row>& rows) {
  const Sitting sitting{
      .commit = "1a2b3c4d5", .date = "2026-11-22", .on = "cpu", .complete = false, .coarse = false, .cases = {"X1"}};
  return nlohmann::json::parse(as_json(sitting, rows));
}

TEST(Report, tells_noted_rows_from_judged_ones) {
  const auto json = json_of(rows_of("", three_rows));
  const auto& rows = json.at("rows");
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[0].at("judged"), true);
  EXPECT_EQ(rows[0].at("pass"), true);
  EXPECT_EQ(rows[1].at("judged"), true);
  EXPECT_EQ(rows[1].at("pass"), false);
  EXPECT_EQ(rows[2].at("judged"), false);
  EXPECT_EQ(rows[2].at("computed"), 3);
  for (const char* claim : {"pass", "error", "tolerance", "reference", "lowest", "highest"})
    EXPECT_FALSE(rows[2].contains(claim)) << "a noted row claims " << claim;
}

TEST(Report, names_the_commit_and_the_day) {
  const auto json = json_of(rows_of("", three_rows));
  EXPECT_EQ(json.at("commit"), "1a2b3c4d5");
  EXPECT_EQ(json.at("date"), "2026-11-22");
  EXPECT_EQ(json.at("cases").size(), 1);
}

TEST(Report, counts_noted_rows_apart) {
  const auto rows = rows_of("", three_rows);
  const Counts c = count(rows);
  EXPECT_EQ(c.judged, 2);
  EXPECT_EQ(c.missed, 1);
  EXPECT_EQ(c.noted, 1);
  EXPECT_EQ(c.lost, 0);
  const std::string table = as_table(rows);
  EXPECT_NE(table.find("3 rows: 2 judged, of which 1 failed; 1 noted, of which 0 without a result"), std::string::npos)
      << table;
  EXPECT_NE(table.find(" noted "), std::string::npos) << table;
}

TEST(Report, shows_a_band_as_a_band_beside_the_number) {
  const auto rows = rows_of("", [](Bench& bench, const Outcome& o) {
    bench.within(o, "run-out", 7.5, {5, 7.08});
    bench.within(o, "factor", 1.2915, {1.24, 1.27}, 0.02);
    bench.at_least(o, "order", 1.5, 1);
    bench.at_most(o, "steps", 40, 48);
    bench.compare(o, "way", 1.005, 1, 0.01);
    bench.measure(o, "distance", 0.03, 0.04);
  });
  const std::string table = as_table(rows);
  for (const char* claim : {" 5 to 7.08 ", " 1.24 to 1.27 +- 2 % ", " >= 1 ", " <= 48 ", " 1 +- 1 % ", " <= 0.04 "})
    EXPECT_NE(table.find(claim), std::string::npos) << claim << "\n" << table;
  const auto json = json_of(rows).at("rows");
  EXPECT_EQ(json[0].at("pass"), false);
  EXPECT_EQ(json[1].at("pass"), true);
  EXPECT_NEAR(json[1].at("error").get<double>(), 0.0169, 1e-4);
  EXPECT_EQ(json[0].at("lowest"), 5);
  EXPECT_EQ(json[0].at("highest"), 7.08);
  EXPECT_TRUE(json[2].at("highest").is_null());
  EXPECT_TRUE(json[3].at("lowest").is_null());
  EXPECT_EQ(json[4].at("lowest"), json[4].at("highest"));
}

TEST(Report, of_a_run_without_a_result_passes_nothing) {
  const auto rows = rows_of("exit code 4: no step converges", three_rows);
  const Counts c = count(rows);
  EXPECT_EQ(c.missed, 2);
  EXPECT_EQ(c.lost, 1);
  const auto json = json_of(rows);
  EXPECT_TRUE(json.at("rows")[2].at("computed").is_null());
  EXPECT_EQ(json.at("rows")[2].at("fault"), "exit code 4: no step converges");
  EXPECT_NE(as_table(rows).find("no step converges"), std::string::npos);
}

TEST(Costs, may_grow_by_fifteen_per_cent_and_two) {
  EXPECT_EQ(cost_bound(0), 2);
  EXPECT_EQ(cost_bound(20), 25);
  EXPECT_EQ(cost_bound(1000), 1152);
  EXPECT_LT(cost_bound(880), 1554) << "what once went unnoticed";
}

TEST(Costs, are_read_as_they_were_written) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "costs.toml";
  const CostBook book{{"A1 quasi-static, quadratic, pcg", {20, 40, 880}}, {"B3 20 m", {2690, 0, 0}}};
  std::ofstream(file) << as_toml(book);
  const CostBook read = read_costs(file);
  ASSERT_EQ(read.size(), 2);
  EXPECT_EQ(read.at("A1 quasi-static, quadratic, pcg").linear, 880);
  EXPECT_EQ(read.at("B3 20 m").steps, 2690);
  std::ofstream(file) << "\"A1\" = [20, 40]\n";
  EXPECT_THROW(read_costs(file), std::runtime_error);
  std::filesystem::remove(file);
  EXPECT_TRUE(read_costs(file).empty());
}

}  // namespace
}  // namespace talus::validation
