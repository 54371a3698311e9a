// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Frames, written beside the run and in run.h5 at its end; work beside the run.
#include "solver/run/recorders/frames.hpp"

#include <numeric>

#include "solver/run/recorders/frame_store.hpp"
#include "solver/run/recorders/side_work.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(FrameRecorder, hands_every_frame_to_the_run_file) {
  const test::Scratch scratch;
  Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 5 - 0.1 * x; });
  fill(d, {4, 8, 4, 8, 0, 2});
  SolveOptions o;
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, On::cpu);
  FrameRecorder frames(scene, o, scratch / "frames");
  frames.belong_to("a1");
  frames.put(0, 0, *solver);
  run_to(*solver, 0.1);
  frames.put(0.1, 1, *solver);
  frames.settle();
  frames.expect(2);
  EXPECT_THROW(frames.expect(3), DataError);
  {
    RunWriter writer(scratch / "run.h5");
    for (const int number : {0, 1}) frames.append_to(writer, number);
    RunMaps maps;
    maps.grid = scene.map;
    const std::vector<double> zero(scene.map.count(), 0.0);
    maps.terrain = maps.before = maps.initial_thickness = maps.deposit_thickness = maps.peak_thickness = zero;
    maps.peak_speed = maps.peak_pressure_kPa = maps.arrival_time = zero;
    writer.finish(maps, {}, {});
  }
  const talus::Run run = read_run(scratch / "run.h5");
  EXPECT_EQ(run.frames.time, (std::vector<double>{0, 0.1}));
  EXPECT_EQ(run.frames.thickness.at(1), solver->thickness());
  const auto& first = run.frames.thickness.at(0);
  EXPECT_NEAR(std::accumulate(first.begin(), first.end(), 0.0), 4 * 4 * 2, 1e-9);
  frames.clear();
  EXPECT_THROW(frames.expect(1), DataError);
}

TEST(FrameStore, keeps_the_frames_of_runs_apart) {
  const test::Scratch scratch;
  const MapGrid grid{.columns = 1, .rows = 1, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  FrameStore store(scratch / "frames");
  for (const char* run : {"a1", "b2"}) {
    store.belong_to(run);
    store.put(0, {}, grid, {1.0});
  }
  store.belong_to("a1");
  store.expect(1);
  std::filesystem::copy_file(scratch / "frames/b2/frame_00000.h5", scratch / "frames/a1/frame_00001.h5");
  RunWriter writer(scratch / "run.h5");
  store.append_to(writer, 0, grid);
  const std::string fault = test::fault_of<DataError>([&] { store.append_to(writer, 1, grid); });
  EXPECT_NE(fault.find("frame_00001.h5: a frame of the run b2 (this is the run a1)"), std::string::npos) << fault;
  store.drop_others();
  EXPECT_EQ(test::names_in(scratch / "frames"), std::vector<std::string>{"a1"});
}

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
}  // namespace talus::solver::testing
