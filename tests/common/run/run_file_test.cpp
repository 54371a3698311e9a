// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5: what is written comes back, a foreign tool sees VTKHDF in it, and broken files are named as such.
#include "common/run/run_file.hpp"

#include <cmath>
#include <limits>

#include "common/run/point_frames.hpp"
#include "tests/common/damage.hpp"
#include "tests/common/tools.hpp"

namespace fs = std::filesystem;

namespace talus {
namespace {

class RunFile : public ::testing::Test {
 protected:
  test::Scratch scratch_;
  const fs::path file_ = scratch_ / "run.h5";
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
  summary.release_density = {2000, 1800};
  summary.provenance = {{"input", "before.tif sha256 12"}, {"input", "after.tif sha256 34"}, {"note", ""}};
  return summary;
}

const RunHistory some_history{
    {{"time_s", "s", "", "", {0, 1}}, {"kinetic_J", "J", "", "", {5, 6}}, {"a", "m", "thickness", "gauge a", {7, 8}}}};

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
    EXPECT_EQ(run.history.columns[c].name, some_history.columns[c].name);
    EXPECT_EQ(run.history.columns[c].values, some_history.columns[c].values);
    EXPECT_EQ(run.history.columns[c].unit, some_history.columns[c].unit);
    EXPECT_EQ(run.history.columns[c].quantity, some_history.columns[c].quantity);
    EXPECT_EQ(run.history.columns[c].place, some_history.columns[c].place);
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
  EXPECT_EQ(points.position, expected.position);
  EXPECT_EQ(points.velocity, expected.velocity);
  EXPECT_EQ(points.volume, expected.volume);
  EXPECT_EQ(points.pressure, expected.pressure);
  EXPECT_EQ(points.id, expected.id);
  EXPECT_EQ(points.release, expected.release);
}

TEST_F(RunFile, is_not_there_until_it_is_finished) {
  {
    RunWriter writer(file_);
    writer.append(some_points(0, 3));
    EXPECT_FALSE(fs::exists(file_));
  }
  EXPECT_EQ(scratch_.files(), 0U) << "an abandoned run leaves nothing behind";
}

TEST_F(RunFile, reads_a_run_without_frames_or_points) {
  RunWriter(file_).finish(some_maps(), {}, {});
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

TEST_F(RunFile, names_a_missing_file) { EXPECT_TRUE(test::holds(fault_of(file_).what, {"no such file"})); }

TEST_F(RunFile, refuses_a_truncated_file_at_any_length_and_says_how_to_mend_it) {
  write_some_run(file_);
  const auto size = fs::file_size(file_);
  for (const double part : {0.0, 0.001, 0.3, 0.7, 0.99}) {
    const auto cut = scratch_ / "cut.h5";
    fs::copy_file(file_, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, static_cast<std::uintmax_t>(part * static_cast<double>(size)));
    const auto fault = fault_of(cut);
    EXPECT_TRUE(test::holds(fault.what, {"cut.h5"}));
    EXPECT_TRUE(test::holds(fault.mend, {"talus-solve"}));
  }
}

TEST_F(RunFile, notices_a_changed_byte_before_hdf5_sees_it) {
  write_some_run(file_);
  const std::string whole = test::text_of(file_);
  for (std::size_t place = 0; place < whole.size() - 128; place += 997) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 0x40);
    EXPECT_TRUE(fault_of(scratch_.write("changed.h5", changed)).why.starts_with("bytes have changed since")) << place;
  }
}

TEST_F(RunFile, refuses_a_run_whose_seal_is_gone) {
  write_some_run(file_);
  EXPECT_EQ(fault_of(scratch_.write("unsealed.h5", test::without_seal(file_))).why,
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
  EXPECT_EQ(fault_with([](RunMaps& maps, auto&, auto&) { maps.grid.cell = 0; }), ": attribute /maps cell_m is 0");
}

TEST_F(RunFile, refuses_a_file_that_is_something_else) {
  std::ofstream(file_) << "these are not the bytes of a run";
  EXPECT_TRUE(test::holds(fault_of(file_).mend, {"talus-solve"}));
}

TEST_F(RunFile, reports_a_write_that_the_system_refuses) {
  std::string fault;
  {
    const test::SmallFiles limit(4096);
    fault = test::fault_of<DataError>([&] {
      RunWriter writer(file_);
      for (int i = 0; i < 20; ++i) writer.append(some_points(i, 20000));
      writer.finish(some_maps(), some_history, some_summary());
    });
  }
  EXPECT_TRUE(test::holds(fault, {file_.string() + ": cannot be written"})) << "as the user knows it";
  EXPECT_TRUE(test::holds(fault, {"File too large", "--out"}));
  EXPECT_EQ(scratch_.files(), 0U) << "nothing half-written may stay";
}

}  // namespace
}  // namespace talus
