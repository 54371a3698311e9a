// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of writers: names, files of a whole run, files of an earlier run.
#include "postprocess/options/writer.hpp"

#include <set>

#include "postprocess/writers/job.hpp"
#include "tests/postprocess/stage_run.hpp"

namespace talus::postprocess {

Writer profile_writer();  // of docs/how-to/extend.md

namespace {

namespace fs = std::filesystem;

struct Outputs : test::StageRun {
  /// Runs the stage on `run` with more keys of [postprocess].
  void write(const talus::Run& run, const std::string& keys) {
    test::write_run(out_ / "run.h5", run);
    recipe_ = "[scene]\nname = \"small\"\n[postprocess]\n" + keys;
    run_it();
  }
  /// Files below OUT, without run.h5.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(out_))
      if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), out_).generic_string());
    names.erase("run.h5");
    return names;
  }
  static bool has_writer(const std::string& file) {
    const auto all = all_writers();
    return std::any_of(all.begin(), all.end(), [&](const auto& writer) { return matches(writer.names, file); });
  }

  /// A run with every optional output.
  talus::Run everything() const {
    talus::Run run = test::small_run();
    run.maps.deposit_of = {{"north scar", run.maps.deposit_thickness}};
    run.maps.critical_thickness = run.maps.initial_thickness;
    run.history.columns = {{"time_s", "s", "", "", {0, 20}},
                           {"gauge_bridge_thickness_m", "m", "thickness", "gauge bridge", {0, 1}}};
    return run;
  }

  const std::string all_keys_ =
      "outputs = [\"report\", \"surface\", \"terrain\", \"points\", \"avaframe-tif\"]\n[postprocess.intensity]\n"
      "guideline = \"swiss-flood\"\n[postprocess.reach_cone]\nangle_deg = 20.0\n";
};

TEST_F(Outputs, have_unique_names_and_files_of_their_own_and_patterns_do_not_reach_into_folders) {
  std::set<std::string> names, patterns;
  for (const auto& writer : all_writers()) {
    EXPECT_TRUE(names.insert(writer.name).second) << writer.name;
    EXPECT_FALSE(writer.names.empty()) << writer.name;
    for (const std::string& pattern : writer.names) EXPECT_TRUE(patterns.insert(pattern).second) << pattern;
  }
  EXPECT_TRUE(matches({"maps/*.qgs"}, "maps/small.qgs"));
  EXPECT_FALSE(matches({"maps/*.qgs"}, "maps/old/small.qgs"));
  EXPECT_FALSE(matches({"score.json"}, "maps/score.json"));
}

TEST_F(Outputs, of_a_run_are_all_named_by_a_writer) {
  write(everything(), all_keys_);
  const auto written = files();
  for (const char* name : {"maps/intensity.tif", "maps/reach.gpkg", "maps/deposit_thickness_north-scar.qml",
                           "maps/sliding_surface.tif", "gauges.csv", "3d/points/points.0000.vtp", "score.json"})
    EXPECT_TRUE(written.contains(name)) << name;
  for (const std::string& file : written) EXPECT_TRUE(has_writer(file)) << "no writer names " << file;
}

TEST_F(Outputs, of_an_earlier_run_that_are_no_longer_wanted_are_deleted) {
  write(everything(), all_keys_);
  scratch.write("out/3d/mine.pvsm", "a state of ParaView");
  fs::create_directories(out_ / "3d" / "volumes");
  scratch.write("out/3d/volumes/flow.0000.vdb", "of an earlier version");
  write(test::small_run(), "outputs = []\n");
  const auto left = files();
  for (const char* name : {"report.html", "gauges.csv", "maps/intensity.tif", "maps/reach_cone.qml"})
    EXPECT_FALSE(left.contains(name)) << name;
  EXPECT_FALSE(fs::exists(out_ / "maps" / "avaframe"));
  EXPECT_EQ(test::names_in(out_ / "3d"), std::vector<std::string>{"mine.pvsm"});
  EXPECT_TRUE(left.contains("score.json"));
}

TEST_F(Outputs, of_the_page_on_extension_are_written) {
  const auto profile = profile_writer();
  Job job{.run = test::small_run(), .out = out_};
  EXPECT_FALSE(profile.wanted(job));
  job.options.outputs = {"profile"};
  EXPECT_TRUE(profile.wanted(job));
  EXPECT_THROW(profile.check(job), DataError) << "there is no thalweg";
  const MapGrid& grid = job.run.maps.grid;
  const double y = grid.south + 1.5 * grid.cell, x = grid.west + 1.5 * grid.cell;
  job.thalweg = {.line = {{x, y}, {x + grid.cell, y}}, .distance = {0, grid.cell}, .given = true, .origin = "test"};
  profile.check(job);
  const auto values = sample_along(job.thalweg, grid, job.run.maps.deposit_thickness);
  EXPECT_EQ(profile.write(job), Files{out_ / "profile.csv"});
  EXPECT_EQ(test::text_of(out_ / "profile.csv"),
            fmt::format("distance_m,deposit_m\n0.00,{:.3f}\n{:.2f},{:.3f}\n", values[0], grid.cell, values[1]));
}

}  // namespace
}  // namespace talus::postprocess
