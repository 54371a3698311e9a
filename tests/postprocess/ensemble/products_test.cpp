// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage with an ensemble: members.h5 and counts in, results out.
#include <gdal_priv.h>
#include <netcdf.h>

#include <memory>
#include <sstream>

#include "common/ensemble/member_table.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/raster_file.hpp"
#include "common/stage/context.hpp"
#include "postprocess/ensemble/likelihood.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/findings.hpp"
#include "tests/postprocess/stage_run.hpp"

namespace talus::postprocess {
namespace {

using test::begins;
using test::holds;

namespace fs = std::filesystem;

struct EnsembleProducts : test::StageRun {
  EnsembleProducts() {
    recipe_ =
        "[scene]\nname = \"slope\"\n[ensemble]\nmembers = 40\nfailed_share = 0.5\n[[ensemble.vary]]\n"
        "key = \"solve.base.friction_angle_deg\"\nlow = 14\nhigh = 26\n";
  }

  void write_members(const std::string& design = "monte-carlo") {
    table_ = test::ensemble_table(40, design);
    write_member_table(out_ / "members.h5", table_);
  }
  void write_part(const MemberRange& part, const char* name = nullptr, std::int64_t fails = 0) {
    write_counts(name != nullptr ? out_ / name : EnsemblePaths{out_}.counts(part),
                 test::part_of_ensemble(table_, part, fails));
  }
  /// The members and the counts of all of them, of which every `fails`-th failed; 0: none.
  void write_all(std::int64_t fails = 0) {
    write_members();
    write_part({0, 40}, "counts.h5", fails);
  }
  /// Lines of members.csv, the first its head.
  std::vector<std::string> rows() const {
    std::istringstream lines(test::text_of(out_ / "members.csv"));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    return rows;
  }
  /// An item of the metadata of a map.
  std::string tag(const std::string& map, const char* name) const {
    const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open((out_ / "probability" / map).c_str()));
    const char* words = dataset ? dataset->GetMetadataItem(name) : nullptr;
    return words == nullptr ? "" : words;
  }
  double share_at(const std::string& name, int column, int row) const {
    return read_raster(out_ / "probability" / name).at(column, row);
  }
  /// How many of the first `members` members reach a column.
  double share_that_reaches(int column, std::int64_t members = 40) const {
    double count = 0;
    for (std::int64_t k = 0; k < members; ++k) count += test::reach_of(table_, k) > column ? 1 : 0;
    return count / static_cast<double>(members);
  }

  static constexpr double deposit_quantum = 1e-3;
  /// Members that keep their deposits, and a survey; the surveyed thickness.
  Raster keep_deposits(const std::string& design) {
    write_members(design);
    EnsembleCounts counts = empty_counts(test::ensemble_scene(), 40, {0, 40}, {});
    counts.fingerprint = "f";
    counts.deposit_quantum = deposit_quantum;
    for (std::int64_t k = 0; k < 40; ++k)
      counts.add(k, test::member_maps(counts.scene, test::reach_of(table_, k), test::depth_of(table_, k)),
                 test::result_of(table_, k));
    write_counts(out_ / "counts.h5", counts);
    Raster surveyed{counts.scene.grid, std::vector<double>(counts.scene.grid.count(), 0.0)};
    for (int row = 4; row < 9; ++row)
      for (int column = 8; column < 20; ++column) surveyed.at(column, row) = 0.1 * column;
    write_geotiff(scratch / "survey.tif", surveyed, {"", "m", {}});
    recipe_ += "[postprocess]\ndeposit_threshold_m = 0.5\n[postprocess.survey]\nthickness = \"survey.tif\"\n";
    return surveyed;
  }

  MemberTable table_;
};

TEST_F(EnsembleProducts, show_the_share_of_the_members_and_its_error) {
  write_all();
  run_it();
  for (const int column : {3, 9, 12, 15, 23}) {
    const double share = share_that_reaches(column);
    EXPECT_EQ(share_at("peak_thickness_above_0.5_m.tif", column, 7), share) << "column " << column;
    EXPECT_NEAR(share_at("peak_thickness_above_0.5_m_error.tif", column, 7), standard_error(share, 40), 1e-12);
    EXPECT_EQ(share_at("peak_thickness_above_0.5_m_members_to_halve.tif", column, 7),
              std::ceil(members_to_halve(share, 40)));
  }
  EXPECT_TRUE(std::isnan(share_at("peak_thickness_above_0.5_m.tif", 9, 0))) << "outside the domain";
  EXPECT_EQ(share_at("peak_thickness_above_0.5_m.tif", 9, 14), 0) << "inside, but never reached";
}

TEST_F(EnsembleProducts, say_in_each_map_of_what_and_of_how_many_it_is) {
  write_all(10);
  run_it();
  const std::pair<const char*, const char*> expected[] = {{"THRESHOLD", "5"},
                                                          {"THRESHOLD_UNIT", "m/s"},
                                                          {"MEMBERS_COUNTED", "36"},
                                                          {"MEMBERS_FAILED", "4"},
                                                          {"DESIGN", "monte-carlo"}};
  for (const auto& [name, words] : expected) EXPECT_EQ(tag("peak_speed_above_5_m_s.tif", name), words) << name;
  EXPECT_TRUE(holds(tag("peak_speed_above_5_m_s.tif", "ERROR_MEANING"), {"Wilson"}));
}

TEST_F(EnsembleProducts, of_parts_are_those_of_the_whole) {
  write_all();
  run_it();
  const std::string whole = test::text_of(out_ / "members.csv"), sensitive = test::text_of(out_ / "sensitivity.csv");
  const Raster mean = read_raster(out_ / "probability/peak_thickness_mean.tif");
  fs::remove(out_ / "counts.h5");
  for (const MemberRange part : {MemberRange{0, 11}, MemberRange{11, 30}, MemberRange{30, 40}}) write_part(part);
  run_it();
  EXPECT_EQ(test::text_of(out_ / "members.csv"), whole);
  EXPECT_EQ(test::text_of(out_ / "sensitivity.csv"), sensitive);
  const Raster again = read_raster(out_ / "probability/peak_thickness_mean.tif");
  for (std::size_t n = 0; n < mean.values.size(); ++n)
    EXPECT_TRUE(mean.values[n] == again.values[n] || std::isnan(mean.values[n])) << n;
}

TEST_F(EnsembleProducts, do_not_depend_on_how_many_threads_make_them) {
  write_all(3);
  const auto written = [&](int threads) {
    context().threads = threads;
    run_it();
    context().threads = 0;
    std::vector<std::pair<fs::path, std::string>> files;  // those that do not say when they were made
    for (const fs::path& file : results_)
      if (const fs::path kind = file.extension(); kind == ".tif" || kind == ".qml" || kind == ".qgs" || kind == ".csv")
        files.emplace_back(file, test::text_of(file));
    return files;
  };
  const auto by_one = written(1), by_many = written(16);
  EXPECT_GT(by_one.size(), 50U);
  ASSERT_EQ(by_one.size(), by_many.size());
  for (std::size_t n = 0; n < by_one.size(); ++n) {
    EXPECT_EQ(by_one[n].first, by_many[n].first);
    EXPECT_TRUE(by_one[n].second == by_many[n].second) << by_one[n].first;
  }
}

TEST_F(EnsembleProducts, have_a_row_for_each_member_also_those_that_failed_or_wait) {
  write_members();
  write_part({0, 30}, nullptr, 10);
  run_it();
  const auto lines = rows();
  ASSERT_EQ(lines.size(), 41u);
  EXPECT_TRUE(begins(
      lines[0], "member,state,solve.base.friction_angle_deg,preprocess.thickness_factor,solve.base.law,run_out_m,"));
  EXPECT_TRUE(begins(lines[1], "0,counted,"));
  EXPECT_TRUE(holds(lines[1], {",coulomb,"}));
  EXPECT_TRUE(begins(lines[10], "9,failed,"));
  EXPECT_TRUE(lines[10].ends_with(",\"the step has fallen below 1e-9 s, \"\"far\"\" too short\",")) << lines[10];
  EXPECT_TRUE(begins(lines[40], "39,waiting,"));
  EXPECT_EQ(share_at("peak_thickness_above_0.5_m.tif", 3, 7), 1) << "of the 27 that are counted";
}

TEST_F(EnsembleProducts, score_every_member_against_the_survey) {
  write_all();
  const EnsembleScene scene = test::ensemble_scene();
  const RunMaps third = test::member_maps(scene, test::reach_of(table_, 3), test::depth_of(table_, 3));
  write_geotiff(scratch / "survey.tif", {scene.grid, third.deposit_thickness}, {"", "m", {}});
  write_geotiff(scratch / "peak.tif", {scene.grid, third.peak_thickness}, {"", "m", {}});
  recipe_ +=
      "[postprocess]\nfootprint_threshold_m = 0.1\ndeposit_threshold_m = 0.1\n"
      "[postprocess.survey]\nthickness = \"survey.tif\"\npeak_thickness = \"peak.tif\"\n";
  run_it();
  const auto lines = rows();
  EXPECT_TRUE(lines.at(0).ends_with(
      ",footprint_csi,footprint_hit_rate,footprint_false_alarm_ratio,deposit_csi,failure,warnings"));
  EXPECT_TRUE(lines.at(4).ends_with(",1,1,0,1,,")) << lines.at(4);
  for (std::size_t k = 0; k + 1 < lines.size(); ++k)
    if (test::reach_of(table_, static_cast<std::int64_t>(k)) != test::reach_of(table_, 3)) {
      EXPECT_FALSE(lines[k + 1].ends_with(",1,1,0,1,,")) << lines[k + 1];
    }
  double held = 0, both = 0, either = 0, squares = 0, cells = 0, surveyed = 0;
  for (std::size_t c = 0; c < scene.grid.count(); ++c) {
    double share = 0;
    for (std::int64_t k = 0; k < 40; ++k)
      if (test::member_maps(scene, test::reach_of(table_, k), test::depth_of(table_, k)).peak_thickness[c] > 0.1)
        share += 1.0 / 40;
    const bool there = third.peak_thickness[c] > 0.1, here = share > 0.5;
    surveyed += there;
    held += there && share > 0.05;
    both += here && there;
    either += here || there;
    cells += share > 0 || there;
    squares += std::pow(share - there, 2);
  }
  EXPECT_LT(both, either);
  EXPECT_EQ(held, surveyed);
  EXPECT_TRUE(holds(
      test::text_of(out_ / "ensemble.html"),
      {fmt::format("\"of\":\"footprint\",\"held\":1.0,\"csi\":{},\"brier\":{:.12f}", both / either, squares / cells)}));
}

TEST_F(EnsembleProducts, say_how_far_every_kept_deposit_is_from_the_surveyed_thickness) {
  const Raster surveyed = keep_deposits("monte-carlo");
  const EnsembleScene scene = test::ensemble_scene();
  run_it();
  const auto lines = rows();
  ASSERT_TRUE(lines.at(0).ends_with(",deposit_csi,thickness_rmse_m,thickness_bias_m,failure,warnings")) << lines[0];
  for (std::int64_t k = 0; k < 40; ++k) {
    const std::string& line = lines.at(static_cast<std::size_t>(k) + 1);
    const RunMaps maps = test::member_maps(scene, test::reach_of(table_, k), test::depth_of(table_, k));
    double squares = 0, sum = 0, cells = 0;
    for (std::size_t c = 0; c < surveyed.values.size(); ++c) {
      const double here = maps.deposit_thickness[c], there = surveyed.values[c];
      if (!(here > 0.5 || there > 0.5)) continue;
      squares += (here - there) * (here - there);
      sum += here - there;
      cells += 1;
    }
    const std::size_t bias_at = line.rfind(',', line.size() - 3), rmse_at = line.rfind(',', bias_at - 1);
    const double bias = std::stod(line.substr(bias_at + 1)), rmse = std::stod(line.substr(rmse_at + 1));
    EXPECT_NEAR(rmse, std::sqrt(squares / cells), deposit_quantum) << line;
    EXPECT_NEAR(bias, sum / cells, deposit_quantum) << line;
  }
}

TEST_F(EnsembleProducts, compare_what_was_measured_at_a_gauge) {
  keep_deposits("monte-carlo");
  const auto logarithms = [&] {
    run_it();
    return Json::parse(test::text_of(out_ / "likelihood.json"))["log_likelihood"];
  };
  const auto before = logarithms();
  EXPECT_TRUE(holds(rows().at(0), {",gauge_bridge_arrival_s,"}));
  recipe_ += "[[calibrate.number]]\nresult = \"gauge_bridge_arrival_s\"\nvalue = 11.0\ndeviation = 0.5\n";
  const auto after = logarithms();
  const Likelihood likelihood({"arrival", "s", {11.0}, {}, {0.25}, 11.0, 0, 0});
  for (std::int64_t k = 0; k < 40; ++k) {
    const double arrival = test::result_of(table_, k).at_gauges.at("gauge_bridge_arrival_s");
    const auto at = static_cast<std::size_t>(k);
    EXPECT_EQ(after[at].is_null(), std::isnan(arrival)) << "a run that never comes there cannot be";
    if (std::isfinite(arrival)) {
      EXPECT_NEAR(after[at].get<double>() - before[at].get<double>(),
                  log_mean(likelihood.by_discrepancy({{arrival}, {}})), 1e-9);
    }
  }
  recipe_ += "[[calibrate.number]]\nresult = \"gauge_dam_arrival_s\"\nvalue = 11.0\ndeviation = 0.5\n";
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { run_it(); }), {"no member has it", "gauge_bridge_arrival_s"}));
}

TEST_F(EnsembleProducts, of_a_calibration_show_what_it_leaves_unexplained) {
  const Raster surveyed = keep_deposits("posterior");
  run_it();
  const auto likelihood = Json::parse(test::text_of(out_ / "likelihood.json"));
  double discrepancy = 0;
  for (const auto& entry : likelihood["compared"][0]["discrepancy"])
    discrepancy += entry[0].get<double>() * entry[2].get<double>();
  const Raster residual = read_raster(out_ / "probability/residual_sigma.tif"),
               mean = read_raster(out_ / "probability/deposit_thickness_mean.tif"),
               spread = read_raster(out_ / "probability/deposit_thickness_deviation.tif");
  int cells = 0;
  for (std::size_t c = 0; c < residual.values.size(); ++c) {
    if (!(std::max(surveyed.values[c], mean.values[c]) > 0.5)) continue;
    ++cells;
    EXPECT_NEAR(residual.values[c], (surveyed.values[c] - mean.values[c]) / std::hypot(discrepancy, spread.values[c]),
                1e-6);
  }
  EXPECT_GT(cells, 60);
  EXPECT_TRUE(test::holds(test::text_of(out_ / "ensemble.html"), {"Residual after the survey"}));
}

TEST_F(EnsembleProducts, are_in_one_netcdf_file_with_thresholds_as_coordinates_and_members_as_a_group) {
  write_all();
  run_it();
  int file = 0, id = 0, group = 0;
  ASSERT_EQ(nc_open((out_ / "probability.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(file, "peak_thickness_threshold", &id), NC_NOERR);
  double thresholds[5];
  ASSERT_EQ(nc_get_var_double(file, id, thresholds), NC_NOERR);
  EXPECT_EQ(thresholds[1], 0.5);
  ASSERT_EQ(nc_inq_varid(file, "probability_of_peak_thickness", &id), NC_NOERR);
  const std::size_t place[] = {1, 7, 12};
  double share = 0;
  ASSERT_EQ(nc_get_var1_double(file, id, place, &share), NC_NOERR);
  EXPECT_EQ(share, share_that_reaches(12));
  for (const char* name : {"probability_error_of_peak_thickness", "peak_speed_quantile", "arrival_time_mean",
                           "hazard_class", "x_bnds", "quantile"})
    EXPECT_EQ(nc_inq_varid(file, name, &id), NC_NOERR) << name;
  ASSERT_EQ(nc_inq_ncid(file, "members", &group), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(group, "run_out_m", &id), NC_NOERR);
  const std::size_t third = 3;
  double run_out = 0;
  ASSERT_EQ(nc_get_var1_double(group, id, &third, &run_out), NC_NOERR);
  EXPECT_EQ(run_out, test::result_of(table_, 3).run_out);
  nc_close(file);
}

TEST_F(EnsembleProducts, are_written_beside_those_of_a_single_run) {
  write_all();
  test::write_run(out_ / "run.h5", test::small_run());
  run_it();
  EXPECT_TRUE(fs::exists(out_ / "probability.nc"));
  EXPECT_TRUE(fs::exists(out_ / "score.json"));
  EXPECT_NE(std::find(results_.begin(), results_.end(), out_ / "probability.nc"), results_.end());
}

TEST_F(EnsembleProducts, are_all_written_and_named_unless_only_checking) {
  write_all();
  run_it(true);
  EXPECT_EQ(std::distance(fs::directory_iterator(out_), {}), 2) << "members.h5 and counts.h5";
  run_it();
  expect_results({"probability/peak_thickness_above_0.5_m.tif", "probability/peak_thickness_above_0.5_m.qml",
                  "probability/peak_thickness_above_0.5_m_error.tif",
                  "probability/peak_thickness_above_0.5_m_members_to_halve.tif",
                  "probability/peak_speed_above_5_m_s.tif", "probability/peak_pressure_above_30_kPa.tif",
                  "probability/arrival_before_10_s.tif", "probability/peak_thickness_q05.tif",
                  "probability/arrival_q50.tif", "probability/peak_speed_mean.tif",
                  "probability/deposit_thickness_deviation.tif", "probability/hazard_class.tif",
                  "probability/terrain.tif", "probability/outlines.gpkg", "probability/slope-ensemble.qgs",
                  "probability.nc", "members.csv", "sensitivity.csv", "postprocess.used.toml"});
  EXPECT_EQ(results_.back(), out_ / "probability.nc") << "the last, by which all is known to be there";
  EXPECT_FALSE(fs::exists(out_ / "score.json")) << "there is no single run";
}

TEST_F(EnsembleProducts, need_members_and_counts_that_belong_together) {
  EXPECT_TRUE(holds(fault(), {"members.h5: no such file"}));
  write_members();
  EXPECT_TRUE(holds(fault(), {"counts.h5: no such file"}));
  write_part({0, 40}, "counts.h5");
  table_.count = 39;
  for (MemberColumn& column : table_.columns) column.values.pop_back();
  table_.own_domain.pop_back();
  write_member_table(out_ / "members.h5", table_);
  EXPECT_TRUE(holds(fault(), {"counts.h5: counts of an ensemble of 40 members"}));
  EXPECT_FALSE(fs::exists(out_ / "probability"));
}

TEST_F(EnsembleProducts, need_a_member_that_is_counted_and_of_members_that_another_recipe_drew_are_refused) {
  write_all(1);
  EXPECT_TRUE(holds(fault(), {"no member is counted (40 failed and 0 wait)"}));
  table_ = test::ensemble_table(40);
  table_.provenance = {{recipe_of_members, "0000000000000000"}};
  write_member_table(out_ / "members.h5", table_);
  write_part({0, 40}, "counts.h5");
  EXPECT_TRUE(holds(fault(), {"members.h5"}));
}

TEST_F(EnsembleProducts, classify_hazard_by_the_matrix_of_the_recipe) {
  write_all();
  recipe_ +=
      "[postprocess.hazard]\nintensity = \"peak-thickness\"\nlimits = [0.5, 2]\nprobability = [0.1, 0.6]\n"
      "matrix = [1, 2, 2, 3]\n";
  run_it();
  for (const int column : {3, 10, 14, 18}) {
    const double weak = share_at("peak_thickness_above_0.5_m.tif", column, 7),
                 strong = share_at("peak_thickness_above_2_m.tif", column, 7);
    const double expected = std::max(weak >= 0.6 ? 2 : weak >= 0.1 ? 1 : 0, strong >= 0.6 ? 3 : strong >= 0.1 ? 2 : 0);
    EXPECT_EQ(share_at("hazard_class.tif", column, 7), expected) << "column " << column;
  }
}

TEST_F(EnsembleProducts, say_what_was_insisted_on_in_maps_and_with_warnings_on_the_page) {
  write_members();
  EnsembleCounts counts = test::part_of_ensemble(table_, {0, 40});
  counts.findings = {test::finding(Severity::refusal, "false-lengths", "a metre is 1.3 m"),
                     test::finding(Severity::warning, "coarse-grid", "the grid is coarse")};
  counts.add_finding(1, test::finding(Severity::refusal, "weight-strain", "strains by 0.6"));
  for (const auto& [member, words] : {std::pair{1, "packed"}, {1, "fast"}, {7, "packed"}})
    counts.add_finding(member, test::finding(Severity::warning, words, words));
  write_counts(out_ / "counts.h5", counts);
  run_it();
  EXPECT_EQ(tag("peak_thickness_q05.tif", "ACCEPTED"),
            "false-lengths: a metre is 1.3 m; weight-strain: in member 1, and maybe in others: strains by 0.6");
  const std::string text = test::text_of(out_ / "ensemble.html");
  EXPECT_TRUE(holds(
      text, {"\"weight-strain\",\"in member 1, and maybe in others: strains by 0.6\"",
             "\"warnings\":[\"the grid is coarse\"]",
             "[\"member 1\",\"packed\"],[\"member 1\",\"fast\"],[\"member 7\",\"packed\"]", "\"members_warned\":2"}));
  EXPECT_TRUE(rows().at(2).ends_with(",,packed; fast")) << rows().at(2);
}

TEST_F(EnsembleProducts, are_not_scored_against_surveys_that_seem_swapped) {
  write_all();
  const EnsembleScene scene = test::ensemble_scene();
  Raster change{scene.grid, std::vector<double>(scene.grid.count(), 0.0)};
  for (int row = 5; row < 11; ++row) {
    for (int column = 2; column < 5; ++column) change.at(column, row) = 3;     // above
    for (int column = 14; column < 17; ++column) change.at(column, row) = -3;  // below
  }
  write_geotiff(scratch.folder() / "change.tif", change, {"", "m", {}});
  recipe_ += "[postprocess]\n%[postprocess.survey]\ndifference = \"change.tif\"\n";
  const std::size_t at = recipe_.find('%');
  const std::string insisting = recipe_;
  recipe_.erase(at, 1);
  EXPECT_TRUE(holds(fault(), {"what rose lies", "accept = [\"swapped-surveys\"]"}));
  recipe_ = insisting;
  recipe_.replace(at, 1, "accept = [\"swapped-surveys\"]\n");
  run_it();
  EXPECT_TRUE(holds(tag("peak_thickness_q05.tif", "ACCEPTED"), {"swapped-surveys"}));
}

TEST_F(EnsembleProducts, refuse_hazard_limits_that_were_not_counted) {
  write_all();
  recipe_ += "[postprocess.hazard]\nintensity = \"peak-speed\"\nlimits = [5, 7]\n";
  EXPECT_TRUE(
      holds(fault(), {"[postprocess.hazard] limits names 7 m/s or more (the runs were counted at 1, 5, 10, 20 m/s)"}));
}

TEST(MemberList, names_ranges_and_cuts_what_is_long) {
  EXPECT_EQ(member_list({3, 7, 8, 9, 12, 13}), "3, 7 to 9, 12, 13");
  EXPECT_EQ(member_list({1, 3, 5, 7, 9}, 2), "1, 3 and 3 more");
  EXPECT_EQ(member_list({}), "");
}

}  // namespace
}  // namespace talus::postprocess
