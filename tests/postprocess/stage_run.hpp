// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage talus-postprocess on a recipe and the files of its output folder.
#pragma once

#include <string>
#include <vector>

#include "postprocess/stage.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::test {

struct StageRun : InScratch {
  const std::filesystem::path out_ = scratch / "out";
  std::string recipe_;
  std::vector<std::filesystem::path> results_;

  StageRun() { std::filesystem::create_directories(out_); }
  void run_it(bool check_only = false) {
    StageContext context{.recipe = recipe::Recipe(scratch.write("recipe.toml", recipe_)),
                         .out = out_,
                         .check_only = check_only,
                         .command_line = "test"};
    postprocess::run(context);
    results_ = context.results;
  }
  std::string fault() {
    return data_fault([&] { run_it(); });
  }
  /// These files below the output folder are there and announced.
  void expect_results(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      EXPECT_TRUE(std::filesystem::exists(out_ / name)) << name;
      EXPECT_NE(std::find(results_.begin(), results_.end(), out_ / name), results_.end()) << name << " not announced";
    }
  }
};

}  // namespace talus::test
