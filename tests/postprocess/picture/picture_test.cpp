// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cairo.h>

#include <map>

#include "common/map/polygon.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/picture/picture.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::small_grid;
using test::small_run;

TEST(Classes, follow_the_deposits_thickness_unless_they_are_given) {
  EXPECT_EQ(class_limits({}, 80).at(1), 2);
  EXPECT_EQ(class_limits({}, 11.9).at(1), 0.5);
  EXPECT_EQ(class_limits({1, 3}, 80), (std::vector<double>{1, 3}));
  const std::vector<double> limits{0.1, 5, 10};
  EXPECT_EQ(class_of(0.05, limits), -1);
  EXPECT_EQ(class_of(5, limits), 1);
  EXPECT_EQ(class_of(1000, limits), 2);
  EXPECT_EQ(class_of(nan, limits), -1);
  EXPECT_EQ(class_label(0, limits), "0.1 \u2013 5");
  EXPECT_EQ(class_label(2, limits), "> 10");
}

TEST(Hillshade, lights_slopes_that_face_the_north_west) {
  MapGrid grid{.columns = 21, .rows = 21, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  std::vector<double> cone;
  for (int row = 0; row < 21; ++row)
    for (int column = 0; column < 21; ++column) cone.push_back(-5.0 * std::hypot(column - 10, row - 10));
  const auto shades = hillshade(grid, cone);
  EXPECT_GT(shades[grid.index(4, 16)], 0.8) << "north-west flank";
  EXPECT_LT(shades[grid.index(16, 4)], 0.2) << "south-east flank";
  EXPECT_TRUE(std::isnan(hillshade(grid, std::vector<double>(grid.count(), nan))[0]));
}

TEST(Isolines, close_around_an_area_even_at_the_edge) {
  const MapGrid grid{.columns = 4, .rows = 4, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  const auto lines = isolines(grid, test::block(grid, 0, 2, 0, 2, 2.0), 1, AtEdge::close);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].front(), lines[0].back());
  for (const auto& [x, y] : lines[0]) EXPECT_TRUE(x >= 0 && y >= 0 && x <= 2 && y <= 2) << x << " " << y;
}

TEST(Isolines, lie_at_the_level_on_a_plane_and_end_at_the_edge) {
  const MapGrid grid{.columns = 5, .rows = 3, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  std::vector<double> plane;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 5; ++column) plane.push_back(grid.x(column));
  const auto lines = isolines(grid, plane, 17.5, AtEdge::end);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].size(), 3U);
  for (const auto& point : lines[0]) EXPECT_DOUBLE_EQ(point[0], 17.5);
}

TEST(Contours, of_a_model_with_a_spike_are_those_of_the_ground) {
  RunMaps maps;
  maps.grid = {.columns = 50, .rows = 50, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  for (int i = 0; i < 2500; ++i) maps.before.push_back(0.1 * (i % 50) * 10);  // 0 to 49 m
  const View whole{{0, 0, 500, 500}, {}};
  EXPECT_EQ(contour_levels(whole, maps).interval, 2);
  maps.before[1234] = 1e9;
  maps.before[77] = -1e9;
  const ContourLevels spiked = contour_levels(whole, maps);
  EXPECT_EQ(spiked.interval, 2);
  EXPECT_LE(spiked.last - spiked.first, 80) << "each level goes over the whole map";
  const View beside{{0, 0, 200, 200}, {}};
  EXPECT_LE(contour_levels(beside, maps).last - contour_levels(beside, maps).first, 80) << "a spike outside the frame";
  EXPECT_LT(contour_levels(whole, {}).last, contour_levels(whole, {}).first) << "nothing there";
}

TEST(View, shows_what_is_affected_with_a_margin_inside_the_grid) {
  const auto run = small_run();
  const auto window = affected_window(run.maps, {}, {});
  EXPECT_LT(window.west, 600030);
  EXPECT_GT(window.east, 600350);
  EXPECT_GE(window.west, run.maps.grid.west);
  EXPECT_LE(window.north, run.maps.grid.north());
  EXPECT_EQ(round_below(7.4), 5);
  EXPECT_EQ(round_below(0.2), 0.2);
  EXPECT_EQ(round_below(1999), 1000);
}

/// The frame of a run of thin flow `thick` far down from its release, beside other thresholds and classes.
Window frame_of(double thick, const Options& options = {}, const std::optional<Survey>& survey = {}) {
  auto run = small_run();
  const auto& grid = run.maps.grid;
  run.maps.deposit_thickness = block(grid, 8, 9, 15, 16, thick);
  run.maps.deposit_thickness[grid.index(38, 28)] = thick;
  run.maps.peak_thickness = run.maps.deposit_thickness;
  return affected_window(run.maps, options, survey);
}

TEST(View, holds_all_that_is_coloured_or_moved) {
  const MapGrid grid = small_grid();
  Options coarse;
  coarse.footprint_threshold = coarse.deposit_threshold = 1;
  Options classes = coarse;
  classes.classes = {0.02, 1};
  for (const auto& [thick, options] :
       {std::pair{0.75, coarse}, {0.1, coarse}, {0.1, Options{}}, {0.02, classes}, {0.004, Options{}}}) {
    const Window window = frame_of(thick, options);
    EXPECT_GE(window.east, grid.west + 39 * grid.cell) << thick;
    EXPECT_GE(window.north, grid.south + 29 * grid.cell) << thick;
  }
}

TEST(View, holds_what_was_surveyed_but_not_its_noise) {
  const MapGrid grid = small_grid();
  Survey survey;
  survey.grid = grid;
  survey.deposit = survey.footprint = survey.measured = block(grid, 38, 39, 28, 29, 0.5);
  survey.footprint_is_change = survey.deposit_is_change = true;
  survey.footprint_threshold = 0.1;
  auto run = small_run();
  for (auto* values : {&run.maps.deposit_thickness, &run.maps.peak_thickness, &run.maps.initial_thickness})
    *values = block(grid, 8, 9, 15, 16, 3);
  EXPECT_GE(affected_window(run.maps, {}, survey).east, grid.west + 39 * grid.cell);
  survey.error = {std::vector<double>(grid.count(), 0.2), 0, 1.96};
  EXPECT_LT(affected_window(run.maps, {}, survey).east, grid.west + 20 * grid.cell) << "2.5 standard errors";
}

TEST(Words, give_volumes_in_three_figures) {
  EXPECT_EQ(volume_words(36.0004e6), "36.0 million m\u00b3");
  EXPECT_EQ(volume_words(5.8e6), "5.80 million m\u00b3");
  EXPECT_EQ(volume_words(22481), "22\u2009500 m\u00b3");
  EXPECT_EQ(volume_words(0), "0 m\u00b3");
}

struct Reading {
  const std::string* bytes;
  std::size_t place = 0;
};

/// Colours of a PNG and how often each occurs.
std::map<std::uint32_t, int> colours_of(const std::string& png) {
  Reading reading{&png};
  const auto read = [](void* closure, unsigned char* data, unsigned length) {
    auto& from = *static_cast<Reading*>(closure);
    if (from.place + length > from.bytes->size()) return CAIRO_STATUS_READ_ERROR;
    std::copy_n(from.bytes->begin() + static_cast<std::ptrdiff_t>(from.place), length, data);
    from.place += length;
    return CAIRO_STATUS_SUCCESS;
  };
  auto* surface = cairo_image_surface_create_from_png_stream(read, &reading);
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  std::map<std::uint32_t, int> colours;
  const int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
  EXPECT_GT(width, 1000);
  EXPECT_GT(height, 1000);
  for (int row = 0; row < height; ++row) {
    const auto* line = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface) +
                                                              row * cairo_image_surface_get_stride(surface));
    for (int column = 0; column < width; ++column) ++colours[line[column] & 0xffffffU];
  }
  cairo_surface_destroy(surface);
  return colours;
}

std::map<std::uint32_t, int> colours_of(const talus::Run& run, const std::optional<Survey>& survey = {}) {
  return colours_of(map_picture({run, {}, survey, make_score(run, {}, survey, thalweg_of(run, {}))}));
}

/// Pixels as strongly coloured (red well above blue) as the classes are; the rest of the map is grey, blue or green.
int coloured_pixels(const std::map<std::uint32_t, int>& colours, int least_lightness, int most_lightness) {
  int count = 0;
  for (const auto& [colour, times] : colours) {
    const int red = static_cast<int>(colour >> 16U), blue = static_cast<int>(colour & 0xffU);
    if (red - blue > 35 && red >= least_lightness && red <= most_lightness) count += times;
  }
  return count;
}

TEST(Picture, shows_the_deposit_in_its_classes) {
  const auto run = small_run();
  const auto colours = colours_of(run);
  // Two classes lie on the ground: 1 - 2 m (orange) and 5 - 10 m (dark red), each over thousands of pixels.
  EXPECT_GT(coloured_pixels(colours, 170, 255), 20000);
  EXPECT_GT(coloured_pixels(colours, 60, 150), 10000);
  auto empty = run;
  empty.maps.deposit_thickness.assign(run.maps.grid.count(), 0.0);
  EXPECT_LT(coloured_pixels(colours_of(empty), 60, 150), 10000) << "no deposit: only the legend is coloured";
}

TEST(Picture, of_a_search_shows_what_fails_first_in_place_of_a_deposit) {
  auto run = small_run();
  const auto dark = [&] { return coloured_pixels(colours_of(run), 60, 150); };
  run.maps.critical_thickness.assign(run.maps.grid.count(), 0.0);
  EXPECT_LT(dark(), 10000) << "nothing fails: only the legend is coloured, though ground lies there";
  std::swap(run.maps.critical_thickness, run.maps.deposit_thickness);
  EXPECT_GT(dark(), 10000);
}

TEST(Picture, of_a_search_says_the_factor_and_the_mass) {
  auto run = small_run();
  const std::optional<Survey> no_survey;
  const Options options;
  const Score score;
  const PictureInput input{run, options, no_survey, score};
  EXPECT_FALSE(shows_search(input));
  run.maps.critical_thickness = run.maps.deposit_thickness;
  run.summary.volume_released = 103000;
  run.summary.provenance.emplace_back("stability.lower_factor", "1.2112");
  EXPECT_TRUE(shows_search(input));
  EXPECT_TRUE(test::holds(search_line(input), {"no factor of safety"})) << "the bracket is not closed";
  EXPECT_EQ(search_numbers(input).size(), 2U) << "ground and lower end";
  run.summary.provenance.emplace_back("stability.factor_of_safety", "1.2174");
  run.summary.provenance.emplace_back("stability.critical_volume_m3", "44318.5");
  EXPECT_TRUE(test::begins(search_line(input), "factor of safety 1.22"));
  const auto numbers = search_numbers(input);
  EXPECT_EQ(std::ranges::count(numbers, std::pair<std::string, std::string>("Fails first", volume_words(44300))), 1);
}

int blue_pixels(const talus::Run& run, const std::optional<Survey>& survey) {
  int count = 0;
  for (const auto& [colour, times] : colours_of(run, survey))
    if (static_cast<int>(colour & 0xffU) - static_cast<int>(colour >> 16U) > 120) count += times;
  return count;
}

TEST(Picture, draws_the_surveys_outline_in_blue) {
  const auto run = small_run();
  std::optional<Survey> survey = Survey{};
  survey->name = "survey";
  survey->grid = small_grid();
  survey->deposit = test::block(survey->grid, 27, 37, 10, 20, 2.0);
  EXPECT_EQ(blue_pixels(run, {}), 0);
  EXPECT_GT(blue_pixels(run, survey), 2000);
}

TEST(Picture, draws_a_bare_polygon_and_shortens_a_long_name) {
  const auto run = small_run();
  std::optional<Survey> survey = Survey{};
  survey->name = "Outline mapped in the field by a commission whose name is longer than any legend";
  survey->grid = small_grid();
  survey->footprint_threshold = 0.5;
  survey->polygons.push_back({{{{600040, 5100080}, {600360, 5100080}, {600360, 5100220}, {600040, 5100220}}}, {}, ""});
  const auto inside = cells_inside(survey->polygons, survey->grid);
  survey->footprint.assign(inside.begin(), inside.end());
  EXPECT_GT(blue_pixels(run, survey), 2000);
}

// Read by Cairo, which knows nothing of the writer.
TEST(Canvas, a_png_shows_what_was_drawn) {
  Canvas canvas(37, 21);
  canvas.fill(Box{0, 0, 37, 21}, {1, 1, 1});
  canvas.fill(Box{3, 2, 9, 7}, {0.2, 0.5, 0.9});
  canvas.text("Talus", 10, 15, {});
  struct Rest {
    std::string bytes;
    std::size_t read = 0;
  } rest{canvas.png()};
  auto* surface = cairo_image_surface_create_from_png_stream(
      [](void* from, unsigned char* to, unsigned length) {
        auto& png = *static_cast<Rest*>(from);
        if (png.read + length > png.bytes.size()) return CAIRO_STATUS_READ_ERROR;
        png.bytes.copy(reinterpret_cast<char*>(to), length, png.read);
        png.read += length;
        return CAIRO_STATUS_SUCCESS;
      },
      &rest);
  ASSERT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  EXPECT_EQ(rest.read, rest.bytes.size());
  ASSERT_EQ(cairo_image_surface_get_width(surface), 37);
  ASSERT_EQ(cairo_image_surface_get_height(surface), 21);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  const std::string drawn = canvas.pixels();
  for (std::size_t n = 0; n < drawn.size(); ++n) {
    if (n % 4 == 3) continue;  // unused
    ASSERT_EQ(data[n / (4 * 37) * stride + n % (4 * 37)], static_cast<unsigned char>(drawn[n])) << n;
  }
  cairo_surface_destroy(surface);
}

// Cairo draws nothing more after a fault; a font that no memory was left for once emptied a map in silence.
TEST(Canvas, what_could_not_be_drawn_is_no_picture) {
  Canvas canvas(20, 20);
  canvas.fill(Box{0, 0, 10, 10}, {0, 0, 0});
  EXPECT_NO_THROW(canvas.png());
  canvas.text("\xff", 1, 15, {});  // not UTF-8: a fault that a test can have
  EXPECT_THROW(canvas.png(), std::runtime_error);
  EXPECT_THROW(canvas.pixels(), std::runtime_error);
}

}  // namespace
}  // namespace talus::postprocess
