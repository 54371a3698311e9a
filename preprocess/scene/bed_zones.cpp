// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/bed_zones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/domain/bed_numbers.hpp"
#include "common/error.hpp"
#include "common/gis/features.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// The share of every cell in which a zone holds, [rows * columns].
std::vector<double> shares_of(const BedZone& zone, const Raster& ground) {
  std::vector<double> share(ground.grid.count(), zone.polygons.empty() ? 1.0 : 0.0);
  if (!zone.polygons.empty()) {
    for (const MapPolygon& polygon : read_united_polygons(zone.polygons, ground.grid.crs_wkt)) {
      const std::vector<double> part = coverage_within(ground.grid, polygon);
      for (std::size_t i = 0; i < part.size(); ++i) share[i] = std::min(1.0, share[i] + part[i]);
    }
  }
  if (!zone.from && !zone.to) return share;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double z = ground.values[i];
    if (!(z >= zone.from.value_or(-recipe::infinity) && z < zone.to.value_or(recipe::infinity))) share[i] = 0;
  }
  return share;
}

/// The mean of what was there and what comes, by the share of the new one; where one is unknown, the larger decides.
double mixed(double before, double after, double share) {
  if (!(share > 0)) return before;
  if (std::isnan(before)) return share >= 0.5 ? after : before;
  return (1 - share) * before + share * after;
}

bool is_angle(std::string_view number) { return number.ends_with("_angle_deg"); }

/// Sets the coefficient of a zone, or adds to it. The raster holds angles [deg], or coefficients.
void lay_coefficient(const BedZone& zone, const std::string& place, const std::vector<double>& share,
                     std::pair<std::string, Raster>& bed) {
  auto& [number, raster] = bed;
  const bool angles = is_angle(number);
  std::vector<char> unknown(share.size()), negative(share.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0)) continue;
    double& value = raster.values[i];
    const double before = angles ? std::tan(value / degrees) : value;
    const double after = zone.friction_coefficient ? *zone.friction_coefficient : before + *zone.added_coefficient;
    unknown[i] = std::isnan(after);
    negative[i] = after < 0;
    const double now = mixed(before, after, share[i]);
    value = angles ? std::atan(now) * degrees : now;
  }
  refuse_cells(raster.grid, unknown, place,
               {"ground where added_coefficient has nothing to add to", "no row above gives mu there",
                "Give a row with friction_coefficient for all of it before this one"});
  refuse_cells(raster.grid, negative, place, {"ground where mu falls below 0", "friction would push", "Add less"});
}

constexpr std::size_t shapefile_name = 10;  ///< letters that a shapefile keeps of an attribute's name

/// What is wrong with a value; empty where nothing is.
std::string fault_of(std::string_view number, double value) {
  constexpr std::array<std::string_view, 4> positive{"turbulence_m_s2", "drag_coefficient", "characteristic_speed_m_s",
                                                     "layer_length_m"};
  if (!std::isfinite(value)) return "it is no number";
  if (is_angle(number)) return value >= 0 && value < 90 ? "" : "an angle lies from 0 to below 90";
  if (number == "pore_pressure_ratio") return value >= 0 && value <= 1 ? "" : "a ratio lies between 0 and 1";
  if (std::find(positive.begin(), positive.end(), number) != positive.end())
    return value > 0 ? "" : "it must be above 0";
  return value >= 0 ? "" : "it must not be below 0";
}

void check_values(const std::filesystem::path& file, const std::vector<MapPolygon>& polygons) {
  std::vector<Fault> faults;
  bool any = false;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const std::string& name = polygons[p].name;
    const std::string feature = fmt::format("polygon {}", p + 1) + (name.empty() ? "" : " (\"" + name + "\")");
    std::set<std::string_view> given;
    for (const auto& [attribute, value] : polygons[p].numbers) {
      const std::string_view number = bed_number_of(attribute);
      if (number.empty()) continue;
      any = true;
      given.insert(number);
      if (const std::string why = fault_of(number, value); !why.empty())
        faults.push_back({fmt::format("{}: {}: {} = {:g}", file.string(), feature, attribute, value), why,
                          "Mend the attribute, or leave it empty for the number in [solve.base]"});
    }
    for (const BedForm& form : bed_forms)
      if (given.contains(form.key) && given.contains(form.of))
        faults.push_back({fmt::format("{}: {}: {} beside {}", file.string(), feature, form.key, form.of),
                          "they are one quantity in two forms", "Leave one of them empty"});
  }
  const auto wanted = [](std::string_view attribute) { return !bed_number_of(attribute).empty(); };
  for (const TextField& text : text_fields(file, wanted))
    faults.push_back({fmt::format("{}: feature {}: {} = \"{}\"", file.string(), text.feature, text.field, text.text),
                      "it is no number", "Mend the attribute, or leave it empty for the number in [solve.base]"});
  if (!any && faults.empty())
    faults.push_back({fmt::format("{}: no attribute of its polygons is a number of the bed (it has: {})", file.string(),
                                  fmt::join(field_names(file), ", ")),
                      "they are found by the names that [solve.base] has for them",
                      "Name an attribute friction_angle_deg, turbulence_m_s2 or another such key"});
  if (!faults.empty()) throw DataError(std::move(faults));
}

void refuse_overlap(const std::filesystem::path& file, const MapGrid& grid,
                    const std::vector<std::vector<double>>& shares) {
  constexpr double rounding = 1e-6;
  std::vector<char> twice(grid.count());
  for (std::size_t i = 0; i < twice.size(); ++i) {
    double sum = 0;
    for (const auto& share : shares) sum += share[i];
    twice[i] = sum > 1 + rounding;
  }
  refuse_cells(grid, twice, file,
               {"ground that two polygons cover", "it is not known which of their numbers hold",
                "Mend the polygons so that they only touch"});
}

/// The scale on which a number has a mean.
double to_mean(std::string_view number, double value) {
  if (is_angle(number)) return std::tan(value * std::numbers::pi / 180);
  return number == "turbulence_m_s2" ? 1 / value : value;
}
double from_mean(std::string_view number, double value) {
  if (is_angle(number)) return std::atan(value) * 180 / std::numbers::pi;
  return number == "turbulence_m_s2" ? 1 / value : value;
}

/// A polygon's value of a number, with the part of every cell that it covers.
struct PolygonNumbers {
  double value;
  const std::vector<double>* share;
};

/// Lays a number over a raster that holds it as `held`: as it is, or in another form with the same scale of means.
void lay_number(std::string_view number, const std::vector<PolygonNumbers>& patches, std::string_view held,
                Raster& raster) {
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    double covered = 0, sum = 0;
    for (const PolygonNumbers& patch : patches) {
      covered += (*patch.share)[i];
      sum += (*patch.share)[i] * to_mean(number, patch.value);
    }
    if (!(covered > 0)) continue;
    const double rest = std::max(1 - covered, 0.0);
    if (std::isnan(raster.values[i])) {
      if (covered >= 0.5) raster.values[i] = from_mean(held, sum / covered);
    } else {
      raster.values[i] = from_mean(held, sum + rest * to_mean(held, raster.values[i]));
    }
  }
}

/// Whether two numbers are an angle and its tangent, or one number.
bool are_one(std::string_view a, std::string_view b) {
  const auto is_form = [](std::string_view key, std::string_view of) {
    const BedForm* const form = bed_form(key);
    return form != nullptr && is_angle(of) && form->of == of;
  };
  return a == b || is_form(a, b) || is_form(b, a);
}

/// The raster of a number of the bed, made without values where there is none yet. Of an angle it may hold the tangent.
std::pair<std::string, Raster>& raster_named(std::vector<std::pair<std::string, Raster>>& bed, std::string_view name,
                                             const MapGrid& grid) {
  for (auto& one : bed)
    if (are_one(one.first, name)) return one;
  return bed.emplace_back(name, Raster{grid, std::vector<double>(grid.count(), nan)});
}

}  // namespace

void lay_bed_zones(const std::vector<BedZone>& zones, const Raster& ground,
                   std::vector<std::pair<std::string, Raster>>& bed) {
  for (std::size_t z = 0; z < zones.size(); ++z) {
    const BedZone& zone = zones[z];
    const std::string place = fmt::format("[[preprocess.bed.zone]] number {}", z + 1);
    const std::vector<double> share = shares_of(zone, ground);
    double cells = 0;
    for (const double part : share) cells += part;
    if (!(cells > 0))
      warn("zone-without-ground", place + ": no ground of the scene lies in it");
    else
      log_info(fmt::format("{}: {:.0f} m2", place, cells * ground.grid.cell * ground.grid.cell));
    if (zone.friction_coefficient || zone.added_coefficient)
      lay_coefficient(zone, place, share, raster_named(bed, "friction_angle_deg", ground.grid));
    const auto lay = [&](std::string_view number, double value) {
      Raster& raster = raster_named(bed, number, ground.grid).second;
      for (std::size_t i = 0; i < share.size(); ++i)
        if (share[i] > 0)
          raster.values[i] =
              from_mean(number, mixed(to_mean(number, raster.values[i]), to_mean(number, value), share[i]));
    };
    if (zone.turbulence) lay("turbulence_m_s2", *zone.turbulence);
    if (zone.drag_coefficient) lay("drag_coefficient", *zone.drag_coefficient);
  }
}

std::string_view bed_number_of(std::string_view attribute) {
  for (const std::string_view number : bed_names) {
    if (attribute == number) return number;
    if (attribute.size() == shapefile_name && attribute == number.substr(0, shapefile_name)) return number;
  }
  return {};
}

void lay_bed_polygons(const std::filesystem::path& file, const Raster& ground,
                      std::vector<std::pair<std::string, Raster>>& bed) {
  const std::vector<MapPolygon> polygons = read_valid_polygons(file, ground.grid.crs_wkt);
  check_values(file, polygons);
  std::vector<std::vector<double>> shares;
  shares.reserve(polygons.size());
  for (const MapPolygon& polygon : polygons) shares.push_back(coverage_within(ground.grid, polygon));
  refuse_overlap(file, ground.grid, shares);
  for (const std::string_view number : bed_names) {
    std::vector<PolygonNumbers> patches;
    double area = 0;
    for (std::size_t p = 0; p < polygons.size(); ++p) {
      for (const auto& [attribute, value] : polygons[p].numbers) {
        if (bed_number_of(attribute) != number) continue;
        patches.push_back({value, &shares[p]});
        for (const double part : shares[p]) area += part * ground.grid.cell * ground.grid.cell;
      }
    }
    if (patches.empty()) continue;
    auto& [held, raster] = raster_named(bed, number, ground.grid);
    lay_number(number, patches, held, raster);
    log_info(fmt::format("[preprocess.bed] polygons: {} of {} polygons, {:.0f} m2", number, patches.size(), area));
    if (!(area > 0))
      warn("polygons-without-ground", fmt::format("{}: no ground of the scene lies in its polygons", file.string()));
  }
}

}  // namespace talus::preprocess
