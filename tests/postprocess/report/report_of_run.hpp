// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small run with all that its report is made from.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "postprocess/report/parts.hpp"
#include "postprocess/report/report.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {

/// A run, its options and score, and the report of them.
class ReportOfRun : public ::testing::Test {
 protected:
  ReportOfRun() {
    run_.maps.grid.crs_wkt = test::utm32n;
    test::write_run(file_, run_);
    thalweg_ = thalweg_of(run_, options_);
  }
  ReportInput input() {
    return {run_,     options_, survey_,     score_ = make_score(run_, options_, survey_, thalweg_),
            thalweg_, stages_,  comparison_, file_};
  }

  /// A survey on a grid of its own, half as fine, that has 1 m less than the simulation everywhere.
  void survey_it() {
    Survey survey;
    survey.name = "last <year>";
    survey.grid = run_.maps.grid;
    for (const double h : run_.maps.deposit_thickness) survey.deposit.push_back(std::max(0.0, h - 1));
    for (const double h : run_.maps.peak_thickness) survey.footprint.push_back(h);
    survey.footprint_threshold = 1;
    survey_ = survey;
  }
  static Json data_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const auto at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at));
  }

  test::Scratch scratch_;
  const std::filesystem::path file_ = scratch_ / "run.h5";
  talus::Run run_ = test::small_run();
  Options options_;
  std::optional<Survey> survey_;
  std::optional<std::string> comparison_;
  Thalweg thalweg_;
  Score score_;
  std::vector<StageText> stages_{{"preprocess", {}},
                                 {"solve", "# What\n# input: a  sha256 0\n\n[solve]\ncfl = 0.4  # default: 0.5\n"}};
};

}  // namespace talus::postprocess
