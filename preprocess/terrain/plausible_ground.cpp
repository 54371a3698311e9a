// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/plausible_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "common/gis/crs.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/way_down.hpp"
#include "preprocess/terrain/height_statistics.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr double refused = 0.01, told = 0.001;  // parts of a length
constexpr double steep_deg = 50;                // between what terrain is and what it is in feet
constexpr double steep_share = 0.1;
constexpr double highest_mountain = 9000;      // [m]
constexpr double lowest_land = -440;           // [m]
constexpr double flat_share = 0.001;           // of the distance across a model
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

/// The heights around cells that hang together.
struct Around {
  std::vector<std::size_t> rim;                   // up to six cells away: resampling mixes heights that far
  std::vector<double> ring;                       // the heights seven to nine cells away
  double lowest = INFINITY, highest = -INFINITY;  // seven to nine cells away
  double steepest = 0;                            // from a cell to the next of all these [m]
};

/// Of a group of `marked` cells; `distance` is 0 everywhere and left so.
Around around_group(const Raster& heights, const std::vector<char>& marked,
                    const std::vector<std::array<int, 2>>& group, std::vector<std::uint8_t>& distance) {
  constexpr int mixed = 6, looked_at = 9;
  const MapGrid& grid = heights.grid;
  std::vector<std::size_t> seen;
  for (const auto& [column, row] : group) seen.push_back(grid.index(column, row));
  for (const std::size_t c : seen) distance[c] = 1;
  Around found;
  for (std::size_t n = 0; n < seen.size(); ++n) {
    const int away = distance[seen[n]];  // and one
    if (away > looked_at) continue;
    for (const std::size_t c : around(grid, seen[n])) {
      if (distance[c] != 0 || marked[c]) continue;
      distance[c] = static_cast<std::uint8_t>(away + 1);
      seen.push_back(c);
      const double z = heights.values[c], step = std::abs(z - heights.values[seen[n]]);
      if (step > found.steepest) found.steepest = step;  // false beside missing cells
      if (away <= mixed) {
        found.rim.push_back(c);
      } else if (!std::isnan(z)) {
        found.ring.push_back(z);
        found.lowest = std::min(found.lowest, z);
        found.highest = std::max(found.highest, z);
      }
    }
  }
  for (const std::size_t c : seen) distance[c] = 0;
  return found;
}

constexpr std::size_t fewest_alike = 4;  // fewer are spikes or pits
constexpr double least_jump = 50, jump_share = 0.25;

constexpr double step_share = 0.25;  // of a jump, from a cell to the next; on a slope it is a seventh

/// The mend of values that stand for missing cells and were mixed with heights.
std::string mend_of_mixed(const std::string& file, double value) {
  return fmt::format(
      "Begin with the model as it was before it was resampled, and declare the value there: "
      "gdalwarp -srcnodata {:.17g}; or cut the place out of {} (gdal_rasterize -burn -9999 around it, "
      "then gdal_edit.py -a_nodata -9999)",
      value, file);
}

/// How far from all that lies seven to nine cells away heights must be to be none: no slope explains it.
double least_step(const Raster& heights, double span_share, const Around& around) {
  return std::max({least_jump, span_share * (around.highest - around.lowest), 9 * heights.grid.cell});
}

/// A value that four cells or more hold exactly, all of them far below or above all that lies around: ground slopes
/// somewhere to its lakes and from its roofs. Returns whether there is one.
bool judge_walled_plateau(const Raster& heights, const std::filesystem::path& file, double value) {
  std::vector<char> marked(heights.values.size());
  std::vector<std::uint8_t> distance(heights.values.size());
  std::size_t cells = 0, first = 0;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    marked[i] = heights.values[i] == value;
    if (marked[i] && cells++ == 0) first = i;
  }
  if (cells < fewest_alike) return false;
  Around all;
  std::vector<char> left = marked;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i]) continue;
    const auto [column, row] = heights.grid.cell_of(i);
    const Around found = around_group(heights, marked, take_connected(heights.grid, left, {{column, row}}), distance);
    all.ring.insert(all.ring.end(), found.ring.begin(), found.ring.end());
    all.steepest = std::max(all.steepest, found.steepest);
  }
  if (all.ring.empty()) return false;
  std::ranges::sort(all.ring);
  constexpr double odd = 0.02;  // of the ring: where a wedge of such cells has become narrower than one, mixing goes on
  const auto few = static_cast<std::size_t>(odd * static_cast<double>(all.ring.size()));
  all.lowest = all.ring[few];
  all.highest = all.ring[all.ring.size() - 1 - few];
  if (all.lowest <= value && value <= all.highest) return false;
  const double next = value < all.lowest ? all.lowest : all.highest, jump = std::abs(next - value);
  if (!(jump > least_step(heights, jump_share, all)) || all.steepest < step_share * jump) return false;
  refuse_unless_accepted(
      "fill-value",
      {fmt::format("{}: {} cells hold {:g} exactly, the first at {}", file.string(), cells, value,
                   place_of(heights.grid, first)),
       fmt::format(
           "seven to nine cells away hardly any height is nearer than {:g} m, with others between: a value that stands "
           "for missing cells, mixed with heights by resampling; or a lake or roof behind walls on all sides",
           next),
       mend_of_mixed(file.string(), value) + ". Where it is ground, all is well"},
      {{"cells", static_cast<double>(cells), "1"}, {"value", value, "m"}, {"jump", jump, "m"}});
  return true;
}

/// Cells beside missing ones that lie far below or above all that lies further out. Returns whether there are.
bool judge_mixed_rims(const Raster& heights, const std::filesystem::path& file) {
  std::vector<char> marked(heights.values.size());
  std::vector<std::uint8_t> distance(heights.values.size());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = std::isnan(heights.values[i]);
  std::vector<char> left = marked;
  std::size_t cells = 0, worst = 0;
  double far = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i]) continue;
    const auto [column, row] = heights.grid.cell_of(i);
    const Around found = around_group(heights, marked, take_connected(heights.grid, left, {{column, row}}), distance);
    if (!(found.lowest <= found.highest)) continue;
    const double jump = least_step(heights, 1, found);
    for (const std::size_t c : found.rim) {
      const double off = std::max(found.lowest - heights.values[c], heights.values[c] - found.highest);
      if (!(off > jump) || found.steepest < step_share * off) continue;
      ++cells;
      if (off > far) far = off, worst = c;
    }
  }
  if (cells < fewest_alike) return false;
  refuse_unless_accepted(
      "mixed-voids",
      {fmt::format("{}: beside cells without elevation {} cells lie up to {:.4g} m below or above all that is seven to "
                   "nine cells away, the worst at {}: {:.6g} m",
                   file.string(), cells, far, place_of(heights.grid, worst), heights.values[worst]),
       "a value that stands for missing cells was mixed with heights by resampling; or a wall of that height hides "
       "what is missing, or heights are in another unit",
       mend_of_mixed(file.string(), -9999) + ". Where it is a wall, all is well"},
      {{"cells", static_cast<double>(cells), "1"}, {"worst", far, "m"}});
  return true;
}

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
  double low = INFINITY, high = -INFINITY;
  for (const double z : heights.values) {
    if (z < low) low = z;
    if (z > high) high = z;
  }
  const auto judge = [&](const Plateau& p, double other_end) {
    const double jump = std::abs(p.next - p.value), span = std::abs(other_end - p.next);
    if (p.cells < fewest_alike || !(jump > std::max(least_jump, jump_share * span))) return false;
    refuse_unless_accepted(
        "fill-value",
        {fmt::format("{}: {} cells hold {:g} exactly, the first at {}", file.string(), p.cells, p.value,
                     place_of(heights.grid, p.first)),
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
  const bool below = judge(plateau_at_end(heights.values, low, high, std::less<>()), high),
             above = judge(plateau_at_end(heights.values, high, low, std::greater<>()), low),
             mixed = !below && !above && judge_walled_plateau(heights, file, most_common_height(heights).value);
  return judge_mixed_rims(heights, file) || below || above || mixed;
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
  double highest = -INFINITY, lowest = INFINITY;
  for (const double z : surface.values) {
    if (z > highest) highest = z;  // false for nodata
    if (z < lowest) lowest = z;
  }
  const MapGrid& grid = surface.grid;
  const double across = grid.cell * std::hypot(grid.columns, grid.rows);
  if (highest - lowest < flat_share * across)
    warn("flat-ground",
         fmt::format(
             "{}: all heights lie within {:.3g} m over {:.4g} m of ground, from {:.6g} to {:.6g} m. A plain may; "
             "else they are kilometres or shares of something, or cells that were never filled in",
             file.string(), highest - lowest, across, lowest, highest),
         {{"relief", highest - lowest, "m"}});
  if (lowest < lowest_land)
    warn(
        "below-all-land",
        fmt::format("{}: the lowest ground lies at {:.6g} m, and the shore of the Dead Sea at {:g} m. The bed of a sea "
                    "may; else depths are written as positive numbers with the sign turned, or what stands for "
                    "missing cells was mixed with heights",
                    file.string(), lowest, lowest_land),
        {{"lowest", lowest, "m"}});
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

void judge_thickness(const Raster& thickness, const std::string& name) {
  constexpr double told_thick = 0.3, refused_thick = 1;
  Sum sum;
  std::size_t cells = 0;
  for (const double t : thickness.values) {
    if (!(t > 0)) continue;
    sum.add(t);
    ++cells;
  }
  if (cells == 0) return;
  const double area = static_cast<double>(cells) * thickness.grid.cell * thickness.grid.cell,
               mean = sum.value() / static_cast<double>(cells), across = 2 * std::sqrt(area / std::numbers::pi);
  if (mean <= told_thick * across) return;
  const std::string words =
      fmt::format("{}: {:.4g} m thick on average, on ground of {} m2, as much as a circle {:.4g} m across", name, mean,
                  grouped(area), across);
  const std::string causes =
      "slides are seldom thicker than a fifth of that. A block that leaves a wall may be; else the thickness is in "
      "another unit (centimetres, feet), an elevation, or a number that marks cells (255, a value for missing ones), "
      "or two surfaces do not share unit, place and datum";
  const std::vector<FindingNumber> numbers{{"thickness", mean, "m"}, {"across", across, "m"}};
  if (mean <= refused_thick * across) return warn("thick-release", words + ": " + causes, numbers);
  refuse_unless_accepted("thick-release",
                         {words, causes, "Look at the numbers (gdalinfo -stats, ogrinfo -al) and bring them to metres"},
                         numbers);
}

void warn_of_step_at_rim(const Raster& thickness, const std::filesystem::path& file) {
  constexpr double steep_rim = 1.5;  // cells, which a surface of 56 degrees rises over one
  const MapGrid& grid = thickness.grid;
  std::vector<double> rim;
  Sum sum;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    const double t = thickness.values[i];
    if (!(t > 0)) continue;
    sum.add(t);
    ++cells;
    const auto near = around(grid, i);
    if (std::any_of(near.begin(), near.end(), [&](std::size_t c) { return !(thickness.values[c] > 0); }))
      rim.push_back(t);
  }
  if (rim.empty()) return;
  const double step = median(rim), mean = sum.value() / static_cast<double>(cells);
  if (!(step > steep_rim * grid.cell) || !(step > mean / 2)) return;
  warn("step-at-rim",
       fmt::format("{}: the sliding surface does not come up to the ground: along its rim it ends {:.3g} m below, of "
                   "{:.3g} m on average. An outline may cut it so; else it has another datum, unit or place than the "
                   "ground, or holds depths",
                   file.string(), step, mean),
       {{"step", step, "m"}});
}

}  // namespace talus::preprocess
