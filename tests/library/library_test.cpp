// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs in memory: input given in memory is that of files, and a keeper sees and ends a run.
#include "library/talus.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using recipe::Recipe;

constexpr MapGrid grid{.columns = 30, .rows = 16, .west = 1000, .south = 2000, .cell = 5, .crs_wkt = ""};

/// A mass of 4 m on a plane that falls to the east.
Site slope() {
  Raster bed{grid, std::vector<double>(grid.count())}, mass{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      bed.at(column, row) = 200 - 2.5 * column;
      if (column >= 6 && column < 11 && row >= 5 && row < 10) mass.at(column, row) = 4;
    }
  return {.domain = make_domain(std::move(bed), std::move(mass), 2)};
}

/// A recipe of 1.25 s in steps of a fortieth, and `more` tables.
Recipe moving(const std::string& more, const std::string& keys = "") {
  return Recipe::parse("[solve]\nend_time_s = 1.25\nlargest_step_s = 0.025\nhistory_interval_s = 0.25\n" + keys +
                       "[solve.material]\nyoungs_modulus_Pa = 1e6\n" + more);
}

const std::string coulomb = "[solve.base]\nfriction_angle_deg = 15.0\n";

Result run_on_cpu(const Site& site, const Recipe& recipe) { return run(Plan(site, recipe), On::cpu); }

double volume(const std::vector<double>& thickness) {
  return std::accumulate(thickness.begin(), thickness.end(), 0.0) * grid.cell * grid.cell;
}

TEST(Library, takes_fifty_steps_of_a_domain_in_memory) {
  const Result result = run_on_cpu(slope(), moving(coulomb));
  EXPECT_EQ(result.summary.steps, 50);
  EXPECT_NEAR(volume(result.maps.deposit_thickness), 25 * 25 * 4, 1e-6);
  EXPECT_NE(result.maps.deposit_thickness, result.maps.initial_thickness);
  EXPECT_EQ(result.history.at("time_s").values.size(), 6U);
  EXPECT_EQ(result.points.position.size(), static_cast<std::size_t>(result.summary.particles));
  EXPECT_EQ(result.frames.thickness.back(), result.maps.deposit_thickness);
}

/// Looks at a run at its records, and ends it at the `last` one.
struct Watcher : Keeper {
  std::size_t last;
  std::vector<double> times = {}, volumes = {};
  RunMaps maps = {};
  PointFrame points = {};

  explicit Watcher(std::size_t ends_at) : last(ends_at) {}
  bool record(const Moment& now) override {
    times.push_back(now.time());
    volumes.push_back(volume(now.thickness()));
    maps = now.maps();
    points = now.points();
    return times.size() < last;
  }
};

TEST(Library, a_keeper_sees_each_record_and_ends_the_run) {
  const Plan plan(slope(), moving(coulomb));
  Watcher all(100), some(3);
  const Result whole = run(plan, On::cpu, all), ended = run(plan, On::cpu, some);
  EXPECT_EQ(all.times, (std::vector<double>{0, 0.25, 0.5, 0.75, 1, 1.25}));
  EXPECT_EQ(some.times, (std::vector<double>{0, 0.25, 0.5}));
  EXPECT_EQ(whole.summary.stop_reason, "end of the simulated time");
  EXPECT_EQ(ended.summary.stop_reason, "stopped by the caller");
  EXPECT_EQ(ended.summary.time_end, 0.5);
  for (const double v : all.volumes) EXPECT_NEAR(v, 2500, 1e-6);
  EXPECT_EQ(all.maps.deposit_thickness, whole.maps.deposit_thickness) << "the last record is the end";
  EXPECT_EQ(some.maps.peak_speed, ended.maps.peak_speed);
  EXPECT_EQ(all.points.position, whole.points.position);
}

struct GaveUp {};
struct Impatient : Keeper {
  void pass_steps() override { throw GaveUp{}; }
};

TEST(Library, what_a_keeper_throws_comes_out_an_interruption_does_and_faults_of_a_recipe_do) {
  EXPECT_THROW(prepare(Recipe::parse("[preprocess.laboratory]\n", ".")), RecipeError);
  EXPECT_THROW(prepare(Recipe::parse("[preprocess]\nbefore_dem = \"none.tif\"\nafter_dem = \"none.tif\"\n")),
               DataError);
  const Plan plan(slope(), moving(coulomb));
  Impatient impatient;
  EXPECT_THROW(run(plan, On::cpu, impatient), GaveUp);
  Context context([](LogLevel, const std::string&) {});
  const BindContext bind(context);
  context.interrupt();
  EXPECT_THROW(run(plan, On::cpu), Interrupted);
}

TEST(Library, an_obstacle_in_memory_is_the_one_in_a_file) {
  const test::Scratch scratch;
  Site site = slope();
  site.obstacle_voxel = 0.5;
  site.obstacles = {{"wall", {1056, 2020, 140}, {1058, 2060, 182}, [](double x, double y, double z) {
                       return std::max({1056 - x, x - 1058, 2020 - y, y - 2060, 140 - z, z - 182});
                     }}};
  write_level_sets(scratch / "wall.vdb", site.obstacles, site.obstacle_voxel);
  const std::string wall = coulomb + "[[solve.obstacle]]\nname = \"wall\"\n";
  const Result memory = run_on_cpu(site, moving(wall));
  const Result file = run_on_cpu(slope(), moving(wall + "level_set = \"" + (scratch / "wall.vdb").string() + "\"\n"));
  EXPECT_EQ(memory.maps.deposit_thickness, file.maps.deposit_thickness);
  EXPECT_NE(memory.history.at("obstacle_wall_impulse_x_N_s").values.back(), 0);
  EXPECT_EQ(test::fault_of<RecipeError>([&] { Plan(slope(), moving(wall)); }),
            "[[solve.obstacle]] name = \"wall\": the site has no body of this name (an obstacle without level_set is "
            "one of Site::obstacles). Add it there, or give level_set");
}

TEST(Library, shaking_in_memory_is_that_of_a_file) {
  const test::Scratch scratch;
  Site site = slope();
  site.shaking = {{0, 0.25, 0.5}, {{0, 0, 0}, {-4, 1, 2}, {0, 0, 0}}};
  const std::string file =
      scratch.write("record.csv", "time_s east north up\n0 0 0 0\n0.25 -4 1 2\n0.5 0 0 0\n").string();
  const Result memory = run_on_cpu(site, moving(coulomb));
  const Result read = run_on_cpu(slope(), moving(coulomb + "[solve.shaking]\nfile = \"" + file + "\"\n"));
  EXPECT_EQ(memory.maps.deposit_thickness, read.maps.deposit_thickness);
  EXPECT_NE(memory.maps.deposit_thickness, run_on_cpu(slope(), moving(coulomb)).maps.deposit_thickness);
  site.shaking.time[2] = 0.25;
  EXPECT_THROW(Plan(site, moving(coulomb)), DataError);
  site.shaking.time = {2, 3, 4};
  EXPECT_THROW(Plan(site, moving(coulomb)), RecipeError) << "the run ends before";
}

TEST(Library, a_table_of_one_coefficient_is_coulombs_law_and_a_falling_one_lets_go) {
  const auto table = [](double rest, double slow, double fast) {
    return fmt::format("[solve.base]\nlaw = \"table\"\ntable = [[0, {:.17g}], [0.5, {:.17g}], [2, {:.17g}]]\n", rest,
                       slow, fast);
  };
  for (const std::string keys : {"", "integrator = \"column-implicit\"\n", "precision = \"single\"\n"}) {
    SCOPED_TRACE(keys);
    const Site site = slope();
    const double mu = std::tan(15 * 3.14159265358979323846 / 180);
    const Result constant = run_on_cpu(site, moving(table(mu, mu, mu), keys));
    EXPECT_EQ(constant.maps.deposit_thickness, run_on_cpu(site, moving(coulomb, keys)).maps.deposit_thickness);
    const Result falling = run_on_cpu(site, moving(table(mu, 0.1, 0.05), keys));
    EXPECT_GT(falling.history.at("kinetic_J").values.back(), 1.1 * constant.history.at("kinetic_J").values.back());
  }
}

TEST(Library, refuses_a_domain_that_cannot_be_and_a_recipe_of_many_runs) {
  Raster bed{grid, std::vector<double>(grid.count(), 0.0)}, mass = bed;
  EXPECT_THROW(make_domain(bed, mass), DataError) << "nothing moves";
  mass.values[40] = -1;
  EXPECT_THROW(make_domain(bed, mass), DataError);
  mass.values[40] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(make_domain(bed, mass), DataError);
  mass.values[40] = 1;
  EXPECT_THROW(make_domain(bed, mass, 0, {2, 2, 0}), DataError);
  mass.grid.west += 1;
  EXPECT_THROW(make_domain(bed, mass), DataError);
  const auto many = Recipe::parse("[ensemble]\nmembers = 3\n[solve]\nend_time_s = 1\n");
  EXPECT_THROW(Plan(slope(), many), RecipeError);
  EXPECT_EQ(test::fault_of<RecipeError>([&] { Plan(slope(), moving("[solve.base]\nlaww = \"table\"\n")); }),
            "recipe.toml:8:1: unknown key \"laww\" in [solve.base]. Did you mean \"law\"?");
}

TEST(Library, writes_the_outputs_of_a_result) {
  const test::Scratch scratch;
  const Recipe recipe = moving(coulomb + "[postprocess]\noutputs = []\n");
  const Result result = run_on_cpu(slope(), recipe);
  const auto files = write(result, recipe, scratch / "out");
  for (const char* name : {"out/run.h5", "out/score.json", "out/maps/deposit_thickness.tif"})
    EXPECT_TRUE(std::filesystem::exists(scratch / name)) << name;
  EXPECT_EQ(files.front(), scratch / "out/run.h5");
  const talus::Run read = read_run(files.front());
  EXPECT_EQ(read.maps.deposit_thickness, result.maps.deposit_thickness);
  EXPECT_EQ(read.history.at("kinetic_J").values, result.history.at("kinetic_J").values);
  EXPECT_EQ(read.frames.thickness, result.frames.thickness);
}

}  // namespace
}  // namespace talus
