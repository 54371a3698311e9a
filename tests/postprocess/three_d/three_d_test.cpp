// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The folder 3d/ as a whole: files written, requests refused.
#include "postprocess/three_d/three_d.hpp"

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

class ThreeD : public ::testing::Test {
 protected:
  ThreeD() { test::write_run(scratch_ / "run.h5", run_); }

  std::vector<std::string> written(const ThreeDParts& options) {
    std::vector<std::string> names;
    for (const auto& file : write_three_d(folder_, options, run_, PointFrames(scratch_ / "run.h5")))
      names.push_back(std::filesystem::relative(file, folder_).string());
    return names;
  }

  test::Scratch scratch_;
  talus::Run run_ = test::small_run();
  const std::filesystem::path folder_ = scratch_ / "3d";
};

const ThreeDParts all_of_it{.points = true};

TEST_F(ThreeD, writes_what_is_asked_for_and_names_what_to_open) {
  EXPECT_EQ(written(all_of_it), (std::vector<std::string>{"terrain.vtp", "surface.pvd", "points.pvd", "run.pvd"}));
  EXPECT_EQ(test::names_in(folder_ / "surface"), (std::vector<std::string>{"surface.0000.vtp", "surface.0001.vtp"}));
  EXPECT_EQ(test::names_in(folder_ / "points"), (std::vector<std::string>{"points.0000.vtp"}));
  const std::string all = test::text_of(folder_ / "run.pvd");
  EXPECT_TRUE(test::holds(all, {"timestep=\"20\" part=\"0\" file=\"terrain.vtp\"",
                                "timestep=\"20\" part=\"1\" file=\"surface/surface.0001.vtp\""}));
}

TEST_F(ThreeD, writes_the_ground_and_the_surface_unless_told_otherwise) {
  EXPECT_EQ(written({}), (std::vector<std::string>{"terrain.vtp", "surface.pvd", "run.pvd"}));
  EXPECT_TRUE(written({.surface = false, .terrain = false}).empty());
}

TEST_F(ThreeD, says_its_size_beforehand_within_a_factor_of_four) {
  // The scene is tiny, so that heads of files count.
  talus::Run run = run_;
  for (int i = 0; i < 40; ++i) {
    run.frames.time.push_back(21 + i);
    run.frames.thickness.push_back(run.maps.deposit_thickness);
  }
  const PointFrames points(scratch_ / "run.h5");
  const ThreeDSize size = size_of_three_d({}, run, points);
  write_three_d(folder_, {}, run, points);
  double bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  EXPECT_LT(bytes / 1e6, 4 * size.all());
  EXPECT_GT(bytes / 1e6, size.all() / 4);
}

TEST_F(ThreeD, more_than_is_allowed_is_refused_with_its_parts) {
  const std::string fault =
      test::fault_of<DataError>([&] { check_three_d(all_of_it, run_, PointFrames(scratch_ / "run.h5"), 0.01); });
  EXPECT_TRUE(test::holds(fault, {"3d/ will take about", "0.01 MB are allowed"}));
}

TEST_F(ThreeD, points_need_frames_of_points) {
  RunWriter writer(scratch_ / "none.h5");
  writer.finish(run_.maps, {}, run_.summary);
  const PointFrames none(scratch_ / "none.h5");
  EXPECT_TRUE(
      test::holds(test::fault_of<DataError>([&] { check_three_d({.points = true}, run_, none); }), {"point_frames"}));
  check_three_d({}, run_, none);
}

}  // namespace
}  // namespace talus::postprocess
