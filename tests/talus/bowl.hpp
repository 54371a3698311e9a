// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small scene from two elevation models, run in the process of the test.
#pragma once

#include <functional>
#include <string>

#include <fmt/format.h>

#include "common/run/run_file.hpp"
#include "common/stage/context.hpp"
#include "talus/commands.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// A bowl of 20 x 20 cells of 10 m in which a block of 4 x 4 cells, 4 m thick, fails.
struct RunInProcess : InScratch {
  RunInProcess() {
    write_grid("before.asc", 0);
    write_grid("after.asc", 4);
    scratch.write("recipe.toml",
                  "[preprocess]\nbefore_dem = \"before.asc\"\nafter_dem = \"after.asc\"\n[preprocess.source]\n"
                  "seed_m = [500045, 5000105]\n[preprocess.grid]\n"
                  "layer_height_m = 2.0\n[solve]\nend_time_s = 1.0\n[postprocess]\noutputs = []\n");
  }
  void write_grid(const std::string& name, double depth) const {
    std::ofstream file(scratch / name);
    file << "ncols 20\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n";
    for (int j = 19; j >= 0; --j)
      for (int i = 0; i < 20; ++i) {
        const double x = 10 * i - 95, y = 10 * j - 95;
        const bool fails = i >= 3 && i < 7 && j >= 8 && j < 12;
        file << 0.004 * (x * x + y * y) - (fails ? depth : 0) << (i == 19 ? "\n" : " ");
      }
  }
  command::Request request(const std::string& out) const {
    return {.recipe = scratch / "recipe.toml", .out = scratch / out, .shown = scratch / out, .on = "cpu"};
  }
};

/// A context that keeps its log.
struct Listener {
  std::string text;
  std::function<void(const std::string&)> heard = [](const std::string&) {};
  Context own{[this](LogLevel, const std::string& line) {
    text += line + "\n";
    heard(line);
  }};
};

/// While the object lives, nothing is printed on stdout.
struct NoStdout {
  NoStdout() { testing::internal::CaptureStdout(); }
  NoStdout(const NoStdout&) = delete;
  NoStdout& operator=(const NoStdout&) = delete;
  ~NoStdout() { testing::internal::GetCapturedStdout(); }
};

/// Runs a scene; its results are not printed.
inline int run_in(Listener& listener, const command::Request& request) {
  const BindContext bind(listener.own);
  const NoStdout quiet;
  return command::run_scene(request);
}

/// The bowl again, and the deposit of a run with a known friction as its survey.
struct SurveyedBowl : RunInProcess {
  static constexpr double truth = 19;
  const std::string survey = "[postprocess.survey]\nthickness = \"truth/maps/deposit_thickness.tif\"\n";

  SurveyedBowl() {
    h5::prepare_library();
    scratch.write("truth.toml", recipe(truth) + "[postprocess]\noutputs = []\n");
    command::Request request = this->request("truth");
    request.recipe = scratch / "truth.toml";
    Listener listener;
    EXPECT_EQ(run_in(listener, request), 0) << listener.text;
  }
  static std::string recipe(double friction) {
    return fmt::format(
        "[preprocess]\nbefore_dem = \"before.asc\"\nafter_dem = \"after.asc\"\n[preprocess.source]\n"
        "seed_m = [500045, 5000105]\n[preprocess.grid]\nlayer_height_m = 2.0\n[solve]\nend_time_s = 20.0\n"
        "stop_kinetic_fraction = 0.001\n"
        "[solve.base]\nlaw = \"coulomb\"\nfriction_angle_deg = {:.1f}  # of the bed\n",
        friction);
  }
};

}  // namespace talus::test
