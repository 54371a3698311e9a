// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/plausible_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/gis/crs.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {
namespace {

constexpr double refused = 0.01, told = 0.001;  // parts of a length
constexpr double steep_deg = 50;                // between what terrain is and what it is in feet
constexpr double steep_share = 0.1;
constexpr double highest_mountain = 9000;      // [m]
constexpr std::size_t least_cells_told = 100;  // fewer cells have no usual slope

/// The slope [deg] that a tenth of a surface exceeds; 0 where there is too little of it.
double steep_tenth(const Raster& surface) {
  const std::vector<double> all = slope_cosine(surface);
  std::vector<double> cosine;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!std::isnan(surface.values[i])) cosine.push_back(all[i]);
  if (cosine.size() < least_cells_told) return 0;
  const auto tenth = cosine.begin() + static_cast<std::ptrdiff_t>(steep_share * static_cast<double>(cosine.size()));
  std::nth_element(cosine.begin(), tenth, cosine.end());
  return std::acos(std::min(1.0, *tenth)) * 180 / std::numbers::pi;
}

std::string capitalised(std::string words) {
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

/// What to do about heights that cannot be metres, by what the recipe says of them.
std::string unit_advice(VerticalUnit unit) {
  switch (unit) {
    case VerticalUnit::foot:
    case VerticalUnit::us_survey_foot:
      return "The recipe says that they are in feet and they are taken so: check places and nodata of the file";
    case VerticalUnit::metre:
      return "The recipe says metres: if it is wrong, say vertical_unit = \"foot\" in [preprocess]";
    default:
      return "Where they are feet, say so: vertical_unit = \"foot\" (or \"us-survey-foot\") in [preprocess]; it makes "
             "mountains of metres three times lower. Where places are in another unit, name the CRS: gdal_edit.py "
             "-a_srs";
  }
}

/// Cells that hold one extreme value exactly, and how far the nearest other value lies.
struct Plateau {
  double value;
  std::size_t cells = 0, first = 0;
  double next;
};

/// The cells at the end of the values that `before` orders first.
template <class Before>
Plateau plateau_at_end(const std::vector<double>& values, double end, double other_end, const Before& before) {
  Plateau p{.value = end, .next = other_end};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == end) {
      if (p.cells++ == 0) p.first = i;
    } else if (before(values[i], p.next)) {  // false for nodata
      p.next = values[i];
    }
  }
  return p;
}

}  // namespace

bool judge_fill_values(const Raster& heights, const std::filesystem::path& file) {
  constexpr std::size_t least_cells = 4;  // fewer are spikes or pits
  constexpr double least_jump = 50, jump_share = 0.25;
  double low = INFINITY, high = -INFINITY;
  for (const double z : heights.values) {
    if (z < low) low = z;
    if (z > high) high = z;
  }
  const auto judge = [&](const Plateau& p, double other_end) {
    const double jump = std::abs(p.next - p.value), span = std::abs(other_end - p.next);
    if (p.cells < least_cells || !(jump > std::max(least_jump, jump_share * span))) return false;
    const auto columns = static_cast<std::size_t>(heights.grid.columns);
    refuse_unless_accepted(
        "fill-value",
        {fmt::format("{}: {} cells hold {:g} exactly, the first at x {:.1f}, y {:.1f}", file.string(), p.cells, p.value,
                     heights.grid.x(static_cast<int>(p.first % columns)),
                     heights.grid.y(static_cast<int>(p.first / columns))),
         fmt::format("the nearest other height is {:g} m, all others span {:.4g} m: a value that stands for missing "
                     "cells, which the file does not declare as nodata, or a level of another unit or datum",
                     p.next, span),
         fmt::format("Look at the place. Where it is no ground, declare the value: gdal_edit.py -a_nodata {:.17g} {}. "
                     "Where it is (a lake, the sea, a roof), bring the file to one unit and datum, or all is well",
                     p.value, file.string())},
        {{"cells", static_cast<double>(p.cells), "1"}, {"value", p.value, "m"}, {"jump", jump, "m"}});
    return true;
  };
  if (!(low < high)) return false;
  const bool below = judge(plateau_at_end(heights.values, low, high, std::less<>()), high);
  return judge(plateau_at_end(heights.values, high, low, std::greater<>()), low) || below;
}

void judge_lengths(const MapGrid& grid, const std::string& working_crs) {
  const auto scale = grid_scale(grid);
  if (!scale || scale->worst.falsity() <= told) return;
  const auto& [middle, worst] = *scale;
  const std::string words = fmt::format(
      "working grid in {}: a metre on the ground is {:.4g} m along x and {:.4g} m along y on the map in its middle "
      "({:.4g} and {:.4g} m where that is worst); areas and volumes come out {:.4g} times as large",
      crs_name(grid.crs_wkt), middle.x, middle.y, worst.x, worst.y, middle.area);
  const char* const mend = working_crs == "utm" ? "crop the working grid (extent_m in [preprocess.grid]): its corners "
                                                  "lie far outside one UTM zone"
                           : working_crs.empty()
                               ? "set working_crs = \"utm\" in [preprocess], or name a CRS that keeps lengths there"
                               : "name another working_crs in [preprocess], \"utm\" or one that keeps lengths there";
  const std::vector<FindingNumber> numbers{{"length_error", worst.falsity(), "1"}, {"area_factor", middle.area, "1"}};
  if (worst.falsity() > refused) {
    refuse_unless_accepted(
        "false-lengths",
        {words, fmt::format("lengths are off by {:.2g} %; 1 % is allowed", 100 * worst.falsity()), capitalised(mend)},
        numbers);
  } else {
    warn("slightly-false-lengths", fmt::format("{}. To be free of it, {}", words, mend), numbers);
  }
}

void judge_heights(const Raster& surface, const std::filesystem::path& file, VerticalUnit unit) {
  const double steep = steep_tenth(surface);
  double highest = -INFINITY;
  for (const double z : surface.values)
    if (z > highest) highest = z;  // false for nodata
  if (steep <= steep_deg && highest <= highest_mountain) return;
  refuse_unless_accepted(
      "steep-ground",
      {fmt::format("{}: a tenth of the ground is steeper than {:.0f} degrees, the highest lies at {:.0f} m",
                   file.string(), steep, highest),
       fmt::format("few terrains exceed {:.0f} degrees there, and no mountain is higher than {:.0f} m. Rock walls of a "
                   "mountain do, and then all is well; or heights are in feet, which the file does not say (as feet it "
                   "were {:.0f} degrees), or places in another unit than heights. The height of a known summit tells "
                   "of feet, the distance of two known places of the other",
                   steep_deg, highest_mountain,
                   std::atan(std::tan(steep * std::numbers::pi / 180) * 0.3048) * 180 / std::numbers::pi),
       unit_advice(unit)},
      {{"slope_of_steepest_tenth", steep, "degree"}, {"highest", highest, "m"}});
}

}  // namespace talus::preprocess
