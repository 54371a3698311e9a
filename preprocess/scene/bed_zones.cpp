// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/bed_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/terrain/surfaces.hpp"

namespace talus::preprocess {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// The share of every cell in which a zone holds, [rows * columns].
std::vector<double> shares_of(const BedZone& zone, const Raster& ground) {
  std::vector<double> share(ground.grid.count(), zone.polygons.empty() ? 1.0 : 0.0);
  if (!zone.polygons.empty()) {
    for (const MapPolygon& polygon : read_valid_polygons(zone.polygons, ground.grid.crs_wkt)) {
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

/// The mean of what was there and what comes, by the share that the new one has; of what is not known the larger share
/// decides.
double mixed(double before, double after, double share) {
  if (!(share > 0)) return before;
  if (std::isnan(before)) return share >= 0.5 ? after : before;
  return (1 - share) * before + share * after;
}

/// This function sets the coefficient of a zone, or adds to it; the raster holds angles [deg].
void lay_coefficient(const BedZone& zone, const std::string& place, const std::vector<double>& share, Raster& angle) {
  std::vector<char> unknown(share.size()), negative(share.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0)) continue;
    const double before = std::tan(angle.values[i] / degrees);
    const double after = zone.friction_coefficient ? *zone.friction_coefficient : before + *zone.added_coefficient;
    unknown[i] = std::isnan(after);
    negative[i] = after < 0;
    angle.values[i] = std::atan(mixed(before, after, share[i])) * degrees;
  }
  refuse_cells(angle.grid, unknown,
               {place, "ground where added_coefficient has nothing to add to", "no row above gives mu there",
                "Give a row with friction_coefficient for all of it before this one"});
  refuse_cells(angle.grid, negative, {place, "ground where mu falls below 0", "friction would push", "Add less"});
}

/// This function sets xi of a zone.
void lay_turbulence(double xi, const std::vector<double>& share, Raster& turbulence) {
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (share[i] > 0) turbulence.values[i] = 1 / mixed(1 / turbulence.values[i], 1 / xi, share[i]);
  }
}

}  // namespace

Raster& raster_named(std::vector<std::pair<std::string, Raster>>& bed, std::string_view name, const MapGrid& grid) {
  for (auto& [other, raster] : bed) {
    if (other == name) return raster;
  }
  bed.emplace_back(name, Raster{grid, std::vector<double>(grid.count(), nan)});
  return bed.back().second;
}

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
    if (zone.turbulence) lay_turbulence(*zone.turbulence, share, raster_named(bed, "turbulence_m_s2", ground.grid));
  }
}

}  // namespace talus::preprocess
