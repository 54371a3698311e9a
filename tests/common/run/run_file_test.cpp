// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5: what is written comes back, a foreign tool sees VTKHDF in it, and broken files are named as such.
#include <cmath>

#include "common/run/mobility.hpp"
#include "common/run/point_frames.hpp"
#include "tests/postprocess/scene.hpp"

namespace fs = std::filesystem;

namespace talus {
namespace {

struct RunFile : test::InScratch {
  const fs::path file_ = scratch / "run.h5";
};

PointFrame some_points(double time, std::size_t count) {
  PointFrame frame;
  frame.time = time;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    frame.position.push_back({5.0e6 + 0.001 * x, 7.0 * x, time});
    frame.velocity.push_back({static_cast<float>(x), 0.5F, -1.0F});
    frame.volume.push_back(2.0F);
    frame.pressure.push_back(static_cast<float>(100 * i));
    frame.id.push_back(static_cast<std::int32_t>(i));
    frame.release.push_back(0);
  }
  return frame;
}

RunMaps some_maps() {
  RunMaps maps;
  maps.grid = {
      .columns = 4, .rows = 3, .west = 500000, .south = 5000000.25, .cell = 2.5, .crs_wkt = "LOCAL_CS[\"h\u00f6he\"]"};
  for (int i = 0; i < 12; ++i) {
    maps.terrain.push_back(100 + i);
    maps.before.push_back(110 + i);
    maps.initial_thickness.push_back(i % 3);
    maps.deposit_thickness.push_back(1.0 / (i + 1));
    maps.peak_thickness.push_back(i);
    maps.peak_speed.push_back(2 * i);
    maps.peak_pressure_kPa.push_back(0.1 * i);
    maps.arrival_time.push_back(i == 5 ? std::numeric_limits<double>::quiet_NaN() : i);
  }
  maps.threshold = 0.25;
  return maps;
}

RunSummary some_summary() {
  RunSummary summary;
  summary.scene = "s";
  summary.title = "A title";
  summary.version = "0.1.0 (abc)";
  summary.material = "an elastic material";
  summary.bed = "Coulomb friction with an angle of 20\u00b0";
  summary.particles = 1'234'567'890'123;
  summary.volume_released = 1.0 / 3.0;
  summary.layer_height = 2.5;
  summary.density = 2000;
  summary.release_density = {2000, 1800};
  summary.profile = {{"scatter", 0.5}};
  summary.provenance = {{"input", "before.tif sha256 12"}, {"input", "after.tif sha256 34"}, {"note", ""}};
  return summary;
}

const RunHistory some_history = test::small_history();

void write_some_run(const fs::path& file) {
  RunWriter writer(file);
  const auto maps = some_maps();
  writer.append(some_points(0, 5));
  writer.append_thickness(0, maps.grid, maps.initial_thickness);
  writer.append(some_points(1.5, 4));
  writer.append_thickness(1.5, maps.grid, maps.deposit_thickness);
  writer.finish(maps, some_history, some_summary());
}

/// The first fault of reading a file, which must be a DataError.
Fault fault_of(const fs::path& file) {
  try {
    read_run(file);
  } catch (const DataError& error) {
    return error.faults().front();
  }
  ADD_FAILURE() << file << " was read without complaint";
  return {};
}

TEST_F(RunFile, brings_back_maps_frames_history_and_summary) {
  write_some_run(file_);
  const auto run = read_run(file_);
  const auto maps = some_maps();
  EXPECT_EQ(run.maps.grid.columns, 4);
  EXPECT_EQ(run.maps.grid.rows, 3);
  EXPECT_EQ(run.maps.grid.south, maps.grid.south);
  EXPECT_EQ(run.maps.grid.crs_wkt, maps.grid.crs_wkt);
  EXPECT_EQ(run.maps.deposit_thickness, maps.deposit_thickness);
  EXPECT_EQ(run.maps.peak_pressure_kPa, maps.peak_pressure_kPa);
  EXPECT_TRUE(std::isnan(run.maps.arrival_time[5]));
  EXPECT_EQ(run.maps.arrival_time[6], 6);
  EXPECT_EQ(run.maps.threshold, 0.25);
  EXPECT_EQ(run.frames.time, (std::vector<double>{0, 1.5}));
  EXPECT_EQ(run.frames.thickness.at(1), maps.deposit_thickness);
  ASSERT_EQ(run.history.columns.size(), some_history.columns.size());
  for (std::size_t c = 0; c < some_history.columns.size(); ++c) {
    test::expect_same(run.history.columns[c], some_history.columns[c], &HistoryColumn::name, &HistoryColumn::values,
                      &HistoryColumn::unit, &HistoryColumn::quantity, &HistoryColumn::place);
  }
  EXPECT_EQ(run.history.find("kinetic_J"), &run.history.columns[1]);
  EXPECT_EQ(run.history.find("potential_J"), nullptr);
  EXPECT_EQ(run.summary.title, "A title");
  EXPECT_EQ(run.summary.stop_reason, "");
  EXPECT_EQ(run.summary.material, "an elastic material");
  EXPECT_EQ(run.summary.bed, "Coulomb friction with an angle of 20\u00b0");
  EXPECT_EQ(run.summary.particles, 1'234'567'890'123);
  EXPECT_EQ(run.summary.volume_released, 1.0 / 3.0);
  EXPECT_EQ(run.summary.layer_height, 2.5);
  EXPECT_EQ(run.summary.release_density, (std::vector<double>{2000, 1800}));
  EXPECT_EQ(run.summary.provenance, some_summary().provenance);
}

TEST_F(RunFile, gives_its_points_back_frame_by_frame) {
  write_some_run(file_);
  const PointFrames frames(file_);
  EXPECT_EQ(frames.time(), (std::vector<double>{0, 1.5}));
  EXPECT_EQ(frames.points(0), 5U);
  EXPECT_EQ(frames.most_points(), 5U);
  EXPECT_EQ(frames.all_points(), 9U);
  const PointFrame points = frames.read(1), expected = some_points(1.5, 4);
  EXPECT_EQ(points.time, 1.5);
  using P = PointFrame;
  test::expect_same(points, expected, &P::position, &P::velocity, &P::volume, &P::pressure, &P::id, &P::release);
}

TEST_F(RunFile, is_not_there_until_it_is_finished_and_may_have_no_frames_or_points) {
  {
    RunWriter writer(file_);
    writer.append(some_points(0, 3));
    EXPECT_FALSE(fs::exists(file_));
  }
  EXPECT_EQ(scratch.files(), 0U) << "an abandoned run leaves nothing behind";
  RunSummary summary;
  summary.density = 2000;
  RunWriter(file_).finish(some_maps(), {}, summary);
  const auto run = read_run(file_);
  EXPECT_TRUE(run.frames.time.empty());
  EXPECT_EQ(PointFrames(file_).most_points(), 0U);
  EXPECT_EQ(run.summary.layer_height, 0);
  EXPECT_TRUE(run.history.columns.empty());
}

TEST_F(RunFile, holds_vtkhdf_as_h5dump_sees_it) {
  ASSERT_EQ(std::system("command -v h5dump > /dev/null"), 0) << "install hdf5-tools";
  write_some_run(file_);
  const auto header =
      test::output_of("h5dump -a /VTKHDF/Type -a /VTKHDF/Version -a /VTKHDF/Steps/NSteps '" + file_.string() + "'");
  EXPECT_TRUE(test::holds(header, {"UnstructuredGrid"}));
  EXPECT_TRUE(test::holds(header, {"STRSIZE 16"})) << "fixed length";
  EXPECT_TRUE(test::holds(header, {"H5T_CSET_ASCII"}));
  EXPECT_TRUE(test::holds(header, {"(0): 2, 0"})) << "version 2.0";
  EXPECT_FALSE(test::holds(header, {"error"}));
  const auto dump = [&](const std::string& name) {
    return test::output_of("h5dump -w 0 -d /VTKHDF/" + name + " '" + file_.string() + "'");
  };
  EXPECT_TRUE(test::holds(dump("NumberOfPoints"), {"(0): 5, 4"}));
  EXPECT_TRUE(test::holds(dump("Steps/Values"), {"(0): 0, 1.5"}));
  EXPECT_TRUE(test::holds(dump("Steps/PointOffsets"), {"(0): 0, 5"}));
  EXPECT_TRUE(test::holds(dump("Steps/CellOffsets"), {"(0): 0, 5"}));
  EXPECT_TRUE(test::holds(dump("Steps/PartOffsets"), {"(0): 0, 1"}));
  EXPECT_TRUE(test::holds(dump("Steps/PointDataOffsets/velocity"), {"(0): 0, 5"}));
  EXPECT_TRUE(test::holds(dump("Connectivity"), {"(0): 0, 1, 2, 3, 4, 0, 1, 2, 3"}));
  EXPECT_TRUE(test::holds(dump("Offsets"), {"(0): 0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4"}));
  EXPECT_TRUE(test::holds(dump("Types"), {"(0): 1, 1, 1, 1, 1, 1, 1, 1, 1"}));
  EXPECT_TRUE(test::holds(dump("Points"), {"( 9, 3 )"}));
}

TEST_F(RunFile, names_a_missing_file_and_refuses_one_that_is_something_else) {
  EXPECT_TRUE(test::holds(fault_of(file_).what, {"no such file"}));
  std::ofstream(file_) << "these are not the bytes of a run";
  EXPECT_TRUE(test::holds(fault_of(file_).mend, {"talus-solve"}));
}

TEST_F(RunFile, refuses_a_truncated_file_at_any_length_and_says_how_to_mend_it) {
  write_some_run(file_);
  const auto size = fs::file_size(file_);
  for (const double part : {0.0, 0.001, 0.3, 0.7, 0.99}) {
    const auto cut = scratch / "cut.h5";
    fs::copy_file(file_, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, static_cast<std::uintmax_t>(part * static_cast<double>(size)));
    const auto fault = fault_of(cut);
    EXPECT_TRUE(test::holds(fault.what, {"cut.h5"}));
    EXPECT_TRUE(test::holds(fault.mend, {"talus-solve"}));
  }
}

TEST_F(RunFile, notices_a_changed_byte_before_hdf5_sees_it_and_a_missing_seal) {
  write_some_run(file_);
  const std::string whole = test::text_of(file_);
  for (std::size_t place = 0; place < whole.size() - 128; place += 997) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 0x40);
    EXPECT_TRUE(fault_of(scratch.write("changed.h5", changed)).why.starts_with("bytes have changed since")) << place;
  }
  EXPECT_EQ(fault_of(scratch.write("unsealed.h5", test::without_seal(file_))).why,
            "its checksum is missing: another program wrote or changed it, or its end is lost");
}

TEST_F(RunFile, refuses_numbers_that_cannot_be_with_their_place) {
  const auto fault_with = [&](const auto& change) {
    RunMaps maps = some_maps();
    RunHistory history = some_history;
    RunSummary summary = some_summary();
    change(maps, history, summary);
    RunWriter(file_).finish(maps, history, summary);
    const Fault fault = fault_of(file_);
    return fault.what.substr(file_.string().size());
  };
  EXPECT_EQ(fault_with([](RunMaps& maps, auto&, auto&) { maps.peak_speed[3] = -1; }),
            ": dataset /maps/peak_speed holds -1 at place 3");
  EXPECT_EQ(fault_with([](RunMaps& maps, auto&, auto&) { maps.terrain[11] = 1.0 / 0.0; }),
            ": dataset /maps/terrain holds inf at place 11");
  EXPECT_EQ(fault_with([](auto&, RunHistory& history, auto&) {
              history.columns[0].values = {1, 0};
            }),
            ": dataset /history/time_s holds 0 behind 1");
  EXPECT_EQ(fault_with([](auto&, auto&, RunSummary& summary) { summary.particles = -1; }),
            ": attribute / particles is -1");
  EXPECT_EQ(fault_with([](auto&, auto&, RunSummary& summary) { summary.density = std::nan(""); }),
            ": attribute / density_kg_m3 is nan");
  EXPECT_EQ(fault_with([](RunMaps& maps, auto&, auto&) { maps.grid.cell = 0; }),
            ": attributes /maps cell_m, west_m and south_m are 0, 500000 and 5e+06");
}

TEST_F(RunFile, reports_a_write_that_the_system_refuses) {
  const std::string fault = full_disk_fault(4096, [&] {
    RunWriter writer(file_);
    for (int i = 0; i < 20; ++i) writer.append(some_points(i, 20000));
    writer.finish(some_maps(), some_history, some_summary());
  });
  EXPECT_TRUE(test::holds(fault, {"./run.h5: cannot be written"})) << "as the user knows it";
  EXPECT_TRUE(test::holds(fault, {"File too large", "ulimit -f"}));
  EXPECT_EQ(scratch.files(), 0U) << "nothing half-written may stay";
}

TEST(Mobility, finds_the_crown_on_the_surface_before_of_a_thin_release_too) {
  const auto run = test::small_run();
  const auto place = crown(run.maps, 1.0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x, run.maps.grid.x(3))
      << "the slope falls to the east: the westernmost release column is the highest";
  double highest = 0;
  for (int row = 10; row < 20; ++row) highest = std::max(highest, run.maps.before[run.maps.grid.index(3, row)]);
  EXPECT_EQ(place->z, highest);
  auto thin = test::small_run();
  for (double& h : thin.maps.initial_thickness) h *= 0.05;  // 0.3 m
  EXPECT_TRUE(crown(thin.maps, 1.0));
}

TEST(Mobility, takes_the_middle_of_a_level_crown) {
  auto run = test::small_run();
  for (double& z : run.maps.before) z = 100;
  for (int row = 0; row < run.maps.grid.rows; ++row)
    for (int column = 0; column < run.maps.grid.columns; ++column)
      run.maps.before[run.maps.grid.index(column, row)] -= column;
  const auto place = crown(run.maps, 1.0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x, run.maps.grid.x(3));
  EXPECT_NEAR(place->y, (run.maps.grid.y(10) + run.maps.grid.y(19)) / 2, 0.51 * run.maps.grid.cell);
}

TEST(Mobility, measures_to_the_farthest_cell_above_the_threshold_and_weighs_the_centre_of_mass_by_thickness) {
  const MapGrid grid{.columns = 5, .rows = 1, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const std::vector<double> thickness{0, 3, 2, 0.5, 0}, surface{50, 40, 30, 20, 10};
  const auto toe = farthest(grid, thickness, 1, {5, 5, 50}, surface);
  ASSERT_TRUE(toe);
  EXPECT_EQ(toe->x, 25);
  EXPECT_EQ(toe->z, 30);
  EXPECT_EQ(plan_distance({5, 5, 50}, *toe), 20);
  EXPECT_FALSE(farthest(grid, thickness, 4, {5, 5, 50}, surface));
  const MapGrid three{.columns = 3, .rows = 1, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const auto centre = centre_of_mass(three, {1, nan, 3}, {100, 100, 200});
  ASSERT_TRUE(centre);
  EXPECT_DOUBLE_EQ(centre->x, (5.0 + 3 * 25) / 4);
  EXPECT_DOUBLE_EQ(centre->y, 5);
  EXPECT_DOUBLE_EQ(centre->z, (100.5 + 3 * 201.5) / 4);
  EXPECT_FALSE(centre_of_mass(three, {0, 0, 0}, {}));
}

PointFrame points(double time, const std::vector<std::array<float, 3>>& velocities) {
  PointFrame frame;
  frame.time = time;
  for (const auto& velocity : velocities) {
    frame.velocity.push_back(velocity);
    frame.position.push_back({0, 0, 0});
    frame.volume.push_back(2.0F * static_cast<float>(frame.volume.size() + 1));
    frame.pressure.push_back(0);
    frame.id.push_back(0);
    frame.release.push_back(0);
  }
  return frame;
}

RunMaps one_cell() {
  RunMaps maps;
  maps.grid = {.columns = 1, .rows = 1, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  for (const auto field :
       {&RunMaps::terrain, &RunMaps::before, &RunMaps::initial_thickness, &RunMaps::deposit_thickness,
        &RunMaps::peak_thickness, &RunMaps::peak_speed, &RunMaps::peak_pressure_kPa, &RunMaps::arrival_time})
    maps.*field = {0};
  return maps;
}

using Motion = test::InScratch;

TEST_F(Motion, counts_the_volume_of_points_faster_than_a_speed_and_is_empty_without_points) {
  RunWriter writer(scratch / "run.h5");
  writer.append(points(0, {{0, 0, 0}, {0, 0, 0}}));
  writer.append(points(2, {{3, 4, 0}, {0, 0.9F, 0}, {0, 0, -2}}));  // volumes 2, 4, 6; a point has come in
  writer.append(points(4, {}));
  writer.finish(one_cell(), {}, {});
  const auto motion = read_motion(scratch / "run.h5", 1);
  EXPECT_EQ(motion.time, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(motion.volume, (std::vector<double>{0, 8, 0}));
  EXPECT_EQ(motion.mean_speed, (std::vector<double>{0, (5.0 * 2 + 2.0 * 6) / 8, 0}));
  RunWriter bare(scratch / "bare.h5");
  bare.append_thickness(0, one_cell().grid, {0});
  bare.finish(one_cell(), {}, {});
  EXPECT_TRUE(read_motion(scratch / "bare.h5", 1).time.empty());
}

}  // namespace
}  // namespace talus
