// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The report's data: what is packed comes back, and the page holds what it should.
#include "postprocess/report/report.hpp"

#include <fmt/format.h>
#include <zlib.h>
#include <nlohmann/json.hpp>

#include "postprocess/report/page.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;

/// A run, its options and score, and the report of them.
struct Report : test::InScratch {
  Report() {
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
  Json data() { return data_of(report_html(input())); }
  static Json data_of(const std::string& page) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const auto at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at));
  }

  const std::filesystem::path file_ = scratch / "run.h5";
  talus::Run run_ = test::small_run();
  Options options_;
  std::optional<Survey> survey_;
  std::optional<std::string> comparison_;
  Thalweg thalweg_;
  Score score_;
  std::vector<StageText> stages_{{"preprocess", {}},
                                 {"solve", "# What\n# input: a  sha256 0\n\n[solve]\ncfl = 0.4  # default: 0.5\n"}};
};

std::string from_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(letters.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

/// As the page does it.
std::vector<double> unpacked(const nlohmann::ordered_json& packed, std::size_t count) {
  const auto stream = from_base64(packed.at("bytes"));
  std::string bytes(2 * count, '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(stream.data()),
                       stream.size()),
            Z_OK);
  EXPECT_EQ(size, 2 * count);
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[k])); };
    const auto q = byte(i) * 256 + byte(count + i);
    values.push_back(q == 0 ? nan : packed.at("offset").get<double>() + packed.at("step").get<double>() * (q - 1));
  }
  return values;
}

TEST(Pack, base64_is_that_of_the_standard_and_a_cut_holds_the_cells_that_touch_the_window) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");  // RFC 4648, section 10
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\x80", 3)), "/wCA");
  const MapGrid grid{.columns = 4, .rows = 3, .west = 100, .south = 0, .cell = 10, .crs_wkt = ""};
  const Raster raster{grid, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  const auto part = cut(raster, Window{110, 10, 130, 25});
  EXPECT_EQ(part.grid.west, 110);
  EXPECT_EQ(part.grid.south, 10);
  EXPECT_EQ(part.values, (std::vector<double>{5, 6, 9, 10}));
  EXPECT_EQ(cut(raster, Window{0, -5, 900, 900}).values, raster.values);
}

TEST(Pack, values_come_back_within_half_a_step_gaps_as_gaps_and_one_value_everywhere_exactly) {
  std::vector<double> values{nan, -3.25, 0, 129.7, 1e-3, nan, 77.123456};
  const auto back = unpacked(packed(values), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isnan(values[i]))
      EXPECT_TRUE(std::isnan(back[i])) << i;
    else
      EXPECT_NEAR(back[i], values[i], 0.5 * (129.7 + 3.25) / 65534 * (1 + 1e-9)) << i;
  EXPECT_EQ(unpacked(packed(std::vector<double>{4.2, 4.2}), 2), (std::vector<double>{4.2, 4.2}));
  for (const double v : unpacked(packed(std::vector<double>{nan, nan}), 2)) EXPECT_TRUE(std::isnan(v));
}

TEST(Pack, merged_cells_keep_volume_peaks_and_first_arrivals) {
  const MapGrid grid{.columns = 3, .rows = 2, .west = 10, .south = 20, .cell = 5, .crs_wkt = ""};
  const Raster raster{grid, {1, 3, nan, 2, nan, nan}};
  const auto mean = coarsened(raster, 2, MergedCells::mean);
  EXPECT_EQ(mean.grid.columns, 2);
  EXPECT_EQ(mean.grid.rows, 1);
  EXPECT_EQ(mean.grid.cell, 10);
  EXPECT_EQ(mean.values[0], 2);
  EXPECT_TRUE(std::isnan(mean.values[1]));
  EXPECT_EQ(coarsened(raster, 2, MergedCells::largest).values[0], 3);
  EXPECT_EQ(coarsened(raster, 2, MergedCells::smallest).values[0], 1);
  EXPECT_EQ(factor_for(raster.grid, 6), 1);
  EXPECT_EQ(factor_for(raster.grid, 5), 2);
}

TEST(ReportLimits, differences_have_a_round_symmetric_scale_that_single_cells_do_not_move) {
  std::vector<double> differences(1000, 0.9);
  differences[7] = 80;
  differences[9] = nan;
  EXPECT_EQ(difference_limits(differences), (std::vector<double>{0.2, 0.5, 1}));
  EXPECT_EQ(difference_limits({-4.0, 4.0}), (std::vector<double>{1, 2.5, 5}));
  EXPECT_EQ(difference_limits({}), (std::vector<double>{0.2, 0.5, 1}));
}

Json layer_of(const Json& data, const std::string& id) {
  for (const auto& layer : data.at("map").at("layers"))
    if (layer.at("id") == id) return layer;
  ADD_FAILURE() << "no layer " << id;
  return {};
}

TEST_F(Report, layers_hold_the_maps_that_the_geotiffs_hold) {
  const Json data = this->data();
  const auto layer = layer_of(data, "deposit");
  const auto& grid = layer.at("grid");
  const int columns = grid.at("columns"), rows = grid.at("rows");
  const auto values = unpacked(layer.at("data"), static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const int first = static_cast<int>((grid.at("west").get<double>() - run_.maps.grid.west) / 10);
  const int bottom = static_cast<int>((grid.at("south").get<double>() - run_.maps.grid.south) / 10);
  int compared = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const auto i = run_.maps.grid.index(first + column, bottom + row);
      if (std::isnan(run_.maps.terrain[i])) continue;
      EXPECT_NEAR(values[static_cast<std::size_t>(row * columns + column)], run_.maps.deposit_thickness[i],
                  6.5 / 65534);
      ++compared;
    }
  EXPECT_GT(compared, 500);
}

TEST_F(Report, has_no_layer_of_a_survey_without_one_and_hands_on_what_two_models_say_of_one_another) {
  const Json bare = data();
  for (const auto& layer : bare.at("map").at("layers")) {
    EXPECT_NE(layer.at("id"), "difference");
    EXPECT_NE(layer.at("id"), "surveyed");
  }
  EXPECT_TRUE(bare.at("run").at("survey").is_null());
  EXPECT_TRUE(data().at("surveys").is_null());
  comparison_ = R"({"alignment": {"known": true, "after_lies_east_m": 4.02}})";
  EXPECT_EQ(data().at("surveys").at("alignment").at("after_lies_east_m"), 4.02);
  comparison_ = "{ cut sho";
  EXPECT_THROW(report_html(input()), DataError);
}

TEST_F(Report, difference_is_simulated_minus_surveyed_where_either_is_a_deposit) {
  survey_it();
  const auto layer = layer_of(data(), "difference");
  const auto& grid = layer.at("grid");
  double sum = 0;
  int cells = 0;
  for (const double d :
       unpacked(layer.at("data"), grid.at("columns").get<std::size_t>() * grid.at("rows").get<std::size_t>())) {
    if (std::isnan(d)) continue;
    sum += d;
    ++cells;
  }
  EXPECT_EQ(cells, 100);  // the deposit's cells, 1.5 m and more
  EXPECT_NEAR(sum / cells, 1, 1e-9);
}

TEST_F(Report, a_title_cannot_end_the_script_that_holds_the_data) {
  survey_it();
  run_.summary.title = "</script><b>Slope & \"co\"";
  const auto page = report_html(input());
  EXPECT_FALSE(holds(page, {"</script><b>"}));
  EXPECT_TRUE(holds(page, {"<title>&lt;/script&gt;&lt;b&gt;Slope &amp; &quot;co&quot;</title>"}));
  const auto data = data_of(page);
  EXPECT_EQ(data.at("run").at("title"), run_.summary.title);
  EXPECT_EQ(data.at("run").at("material"), "an elastic material");
  EXPECT_EQ(data.at("run").at("bed"), "no friction");
  EXPECT_EQ(data.at("run").at("survey").at("name"), "last <year>");
}

TEST_F(Report, parameters_come_with_defaults_stages_may_be_missing_and_a_release_has_both_conventions) {
  const auto stages = data().at("stages");
  EXPECT_TRUE(stages.at(0).at("missing"));
  EXPECT_FALSE(stages.at(1).at("missing"));
  const auto key = stages.at(1).at("keys").at(0);
  EXPECT_EQ(key.at("table"), "solve");
  EXPECT_EQ(key.at("value"), "0.4");
  EXPECT_EQ(key.at("default"), "0.5");
  EXPECT_EQ(stages.at(1).at("facts").at(0), (Json{"input", "a  sha256 0"}));
  test::tilt(run_.maps);
  const auto release = volumes_json(run_, 1.0).at(0);
  EXPECT_EQ(release.at("name"), "Release");
  EXPECT_NEAR(release.at("volume").get<double>(), 24000, 1e-9);
  EXPECT_NEAR(release.at("volume_if_normal").get<double>(), 24000 / 0.8, 1e-8);
  EXPECT_NEAR(release.at("area_projected").get<double>(), 4000, 1e-9);
  EXPECT_NEAR(release.at("area_true").get<double>(), 4000 / 0.8, 1e-8);
  EXPECT_NEAR(release.at("thickest_normal").get<double>(), 6 * 0.8, 1e-12);
}

TEST_F(Report, columns_of_the_history_at_a_place_come_with_what_they_measure_there) {
  run_.history.columns = {{"time_s", "s", "", "", {0, 20}},
                          {"gauge_toe_thickness_m", "m", "thickness", "gauge toe", {0, 3}}};
  const Json series = data()["series"];
  EXPECT_EQ(series["history"]["time_s"], (Json{0, 20}));
  EXPECT_EQ(series["history"]["gauge_toe_thickness_m"], (Json{0, 3}));
  ASSERT_EQ(series["at_places"].size(), 1U);
  EXPECT_EQ(
      series["at_places"][0],
      (Json{{"name", "gauge_toe_thickness_m"}, {"unit", "m"}, {"quantity", "thickness"}, {"place", "gauge toe"}}));
}

TEST_F(Report, profile_follows_the_thalweg_from_the_release_to_the_deposit) {
  survey_it();
  const auto profile = data().at("profile");
  const auto count = profile.at("distance").size();
  ASSERT_GT(count, 10U);
  for (const auto* key :
       {"before", "bed", "deposit_surface", "deposit", "peak", "speed", "surveyed", "surveyed_surface"})
    EXPECT_EQ(profile.at(key).size(), count) << key;
  EXPECT_GT(profile.at("before").at(1).get<double>(), profile.at("before").at(count - 2).get<double>());
}

/// A cap that slides down a bumpy slope, 300 x 300 cells, 60 frames.
Run large_run() {
  auto run = test::small_run();
  auto& maps = run.maps;
  maps.grid.columns = maps.grid.rows = 300;
  const auto& grid = maps.grid;
  const auto cap = [&](double along, double height) {
    std::vector<double> values;
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const double away = std::hypot(column - along, row - 150.0 + 20 * std::sin(0.02 * along)) / 60;
        values.push_back(std::max(0.0, 1 - away * away) * height *
                         (1 + 0.1 * std::sin(0.7 * column) * std::cos(0.9 * row)));
      }
    return values;
  };
  maps.terrain.clear();
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      maps.terrain.push_back(3000 - 6.0 * column + 8 * std::sin(0.31 * row) * std::sin(0.23 * column) +
                             3 * std::sin(1.7 * row + 0.9 * column));
  maps.initial_thickness = cap(60, 80);
  maps.deposit_thickness = cap(240, 40);
  maps.before = maps.terrain;
  run.frames = {};
  maps.peak_thickness.assign(grid.count(), 0);
  for (int frame = 0; frame < 60; ++frame) {
    run.frames.time.push_back(frame);
    run.frames.thickness.push_back(cap(60 + 3 * frame, 80 - 40.0 / 59 * frame));
    for (std::size_t i = 0; i < grid.count(); ++i)
      maps.peak_thickness[i] = std::max(maps.peak_thickness[i], run.frames.thickness.back()[i]);
  }
  maps.peak_speed = maps.peak_pressure_kPa = maps.arrival_time = maps.peak_thickness;
  return run;
}

TEST(ReportSize, a_map_of_300_by_300_cells_with_60_frames_stays_below_ten_megabytes) {
  const test::Scratch scratch;
  const auto run = large_run();
  const Options options;
  const std::optional<Survey> survey;
  test::write_run(scratch / "run.h5", run);
  const auto thalweg = thalweg_of(run, options);
  const auto score = make_score(run, options, survey, thalweg);
  const auto page = report_html({run, options, survey, score, thalweg, {}, {}, scratch / "run.h5"});
  RecordProperty("bytes", static_cast<int>(page.size()));
  EXPECT_LT(page.size(), 10'000'000U);
  EXPECT_GT(page.size(), 1'000'000U);
}

TEST(Page, loads_nothing_and_has_a_place_for_title_and_data) {
  const auto page = page_template();
  EXPECT_NE(page.find("<title>@TITLE@</title>"), std::string_view::npos);
  EXPECT_NE(page.find("id=\"data\">@DATA@</script>"), std::string_view::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string_view::npos);
  for (const auto* words :
       {"<script src", "<link", "url(images/", "sourceMappingURL", "@LEAFLET", "@CHART", "@SCRIPT", "@STYLE"})
    EXPECT_EQ(page.find(words), std::string_view::npos) << words;
}

class ReportWords : public Report {};

TEST_F(ReportWords, volume_in_motion_comes_from_every_record_of_the_history) {
  run_.history.columns = {{"time_s", "s", "", "", {0, 0.5, 1}},
                          {"moving_volume_m3", "m3", "", "", {0, 700, 900}},
                          {"moving_speed_m_s", "m s-1", "", "", {0, 2, 3.25}}};
  Json motion = data()["series"]["motion"];
  EXPECT_TRUE(motion["from_history"]);
  EXPECT_EQ(motion["time"], (Json{0, 0.5, 1}));
  EXPECT_EQ(motion["volume"], (Json{0, 700, 900}));
  EXPECT_EQ(motion["mean_speed"], (Json{0, 2, 3.25}));
  run_.history.columns.resize(2);  // a run from before
  motion = data()["series"]["motion"];
  EXPECT_TRUE(motion.is_null() || !motion["from_history"].get<bool>());
}

TEST_F(ReportWords, gauges_and_obstacles_stand_on_the_map_with_what_was_measured) {
  EXPECT_TRUE(data()["places"].empty());
  const auto window = shown_window(input());
  run_.summary.places = {{"gauge toe", {{{window.west + 30, window.south + 40}}}},
                         {"obstacle wall", {{{0, 0}, {4, 0}, {4, 9}}}}};
  run_.history.columns = {{"time_s", "s", "", "", {0, 20, 40}},
                          {"gauge_toe_thickness_m", "m", "thickness", "gauge toe", {0, 3, 1}},
                          {"x", "N s", "impulse", "obstacle wall", {0, nan, -5}}};
  const Json places = data()["places"];
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0]["kind"], "gauge");
  EXPECT_EQ(places[0]["name"], "toe");
  EXPECT_EQ(places[0]["rings"], (Json{{30.0, 40.0}}));
  EXPECT_EQ(places[0]["measured"][0], (Json{{"quantity", "thickness"}, {"unit", "m"}, {"value", 3.0}, {"time", 20.0}}));
  EXPECT_EQ(places[1]["rings"][0].size(), 6U);
  EXPECT_EQ(places[1]["measured"][0]["value"], -5.0) << "the farthest from zero";
}

TEST_F(ReportWords, another_models_run_is_not_called_surveyed) {
  survey_it();
  survey_->name = "SHALTOP";
  const auto words_of = [](const Score& score) {
    std::string words;
    for (const auto& section : score.sections) {
      words += section.title + "\n";
      for (const auto& entry : section.entries) words += entry.label + "\n";
    }
    for (const auto& [key, why] : score.not_scored) words += why + "\n";
    for (const auto& note : score.notes) words += note + "\n";
    return words;
  };
  EXPECT_TRUE(holds(words_of(make_score(run_, options_, survey_, thalweg_)), {"surveyed deposit volume"}));
  survey_->kind = ReferenceKind::model;
  std::string words = words_of(make_score(run_, options_, survey_, thalweg_));
  EXPECT_TRUE(holds(words, {"reference deposit volume"}));
  const std::string denial = "It was not surveyed.";
  ASSERT_TRUE(holds(words, {denial}));
  words.erase(words.find(denial), denial.size());
  EXPECT_FALSE(holds(words, {"survey"})) << words.substr(words.find("survey") - 60, 120);
  EXPECT_EQ(data()["run"]["survey"]["noun"], "reference");
}

}  // namespace
}  // namespace talus::postprocess
