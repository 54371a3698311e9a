// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/gauges.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace talus::solver {
namespace {

constexpr Column<GaugeReading> gauge_columns[] = {
    {"thickness_m", "m", [](const GaugeReading& r) { return r.thickness; }, "thickness"},
    {"speed_m_s", "m s-1", [](const GaugeReading& r) { return r.speed; }, "mean speed over depth"},
    {"surface_m", "m", [](const GaugeReading& r) { return r.surface; }, "elevation of the surface"},
    {"pore_pressure_Pa", "Pa", [](const GaugeReading& r) { return r.pressure; }, "pore pressure at the bed"},
};
/// The columns of a run; the last one is of those with water in the pores alone.
std::span<const Column<GaugeReading>> columns_of(const WaterOptions& water) {
  return std::span(gauge_columns).first(std::size(gauge_columns) - (water.flows() ? 0 : 1));
}

/// The first of the two cells that a gauge lies between; the last pair where it lies on the last cell.
int first_of_pair(double position, int count) { return std::min(static_cast<int>(std::floor(position)), count - 2); }

bool has_terrain_around(const Scene& scene, double xi, double eta) {
  const GridShape& grid = scene.grid;
  if (!(xi >= 0 && eta >= 0 && xi <= grid.columns - 1 && eta <= grid.rows - 1)) return false;
  const std::size_t low = scene.map.index(first_of_pair(xi, grid.columns), first_of_pair(eta, grid.rows));
  const std::size_t high = low + static_cast<std::size_t>(grid.columns);
  return std::isfinite(grid.terrain[low]) && std::isfinite(grid.terrain[low + 1]) &&
         std::isfinite(grid.terrain[high]) && std::isfinite(grid.terrain[high + 1]);
}

void check_places(const std::vector<GaugeOptions>& gauges, const Scene& scene) {
  std::vector<Fault> faults;
  const MapGrid& map = scene.map;
  for (const GaugeOptions& g : gauges) {
    const auto [xi, eta] = in_cells(map, g.x, g.y);
    if (has_terrain_around(scene, xi, eta)) continue;
    faults.push_back({fmt::format("[[solve.gauge]] name = \"{}\": ({}, {}) lies outside the domain", g.name, g.x, g.y),
                      "a gauge reads between four cells with terrain",
                      fmt::format("Choose x from {} to {} and y from {} to {}, where the elevation model has data",
                                  map.x(0), map.x(map.columns - 1), map.y(0), map.y(map.rows - 1))});
  }
  if (!faults.empty()) throw RecipeError(std::move(faults));
}

}  // namespace

GaugeRecorder::GaugeRecorder(const SolveOptions& options, const Scene& scene)
    : TableRecorder(columns_of(options.water), places_of("gauge", options.gauges)),
      columns_(static_cast<std::size_t>(scene.grid.columns)),
      densities_{options.material.density} {
  check_places(options.gauges, scene);
  for (const PartOptions& part : options.parts) densities_.push_back(part.material.density);
  const TerrainTables& terrain = scene.terrain;
  for (const GaugeOptions& g : options.gauges) {
    const auto [xi, eta] = in_cells(scene.map, g.x, g.y);
    Site site{.xi = xi,
              .eta = eta,
              .bed = terrain.datum + terrain_at(scene.grid, terrain, xi, eta),
              .load = 0,
              .low = scene.map.index(first_of_pair(xi, scene.grid.columns), first_of_pair(eta, scene.grid.rows))};
    const double x = at(site, terrain.slope_x), y = at(site, terrain.slope_y);
    site.load = options.material.density * options.gravity_size() / (1 + x * x + y * y);  // cos^2 of the slope
    sites_.push_back(site);
  }
}

std::vector<GaugeReading> GaugeRecorder::samples(const Instant& now) const {
  const std::vector<double> thickness = now.solver.thickness(), borne = now.solver.grains_share();
  const ParticleState points = now.solver.shown();
  std::vector<GaugeReading> readings;
  for (const Site& site : sites_) {
    const double depth = at(site, thickness);
    readings.push_back({.thickness = depth,
                        .speed = speed_at(site, points),
                        .surface = site.bed + depth,
                        .pressure = borne.empty() ? 0 : (1 - at(site, borne)) * site.load * depth});
  }
  return readings;
}

double GaugeRecorder::at(const Site& site, const std::vector<double>& map) const {
  const std::size_t column = site.low % columns_, row = site.low / columns_;
  const double x = site.xi - static_cast<double>(column), y = site.eta - static_cast<double>(row);
  const double* south = &map[site.low];
  const double* north = south + columns_;
  return (1 - y) * ((1 - x) * south[0] + x * south[1]) + y * ((1 - x) * north[0] + x * north[1]);
}

/// The speed at a gauge: points count by mass and by a hat as wide as a cell to either side of it.
double GaugeRecorder::speed_at(const Site& site, const ParticleState& points) const {
  double mass = 0;
  Vec3<double> momentum{};
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.cell[0][p] < 0) continue;  // has left the domain
    const double x = std::abs(points.cell[0][p] + points.offset[0][p] - site.xi);
    const double y = std::abs(points.cell[1][p] + points.offset[1][p] - site.eta);
    if (x >= 1 || y >= 1) continue;
    const double density = densities_[points.material_of(p)];
    const double share = (1 - x) * (1 - y) * points.volume[p] * density;
    mass += share;
    momentum += Vec3<double>{points.velocity[0][p], points.velocity[1][p], points.velocity[2][p]} * share;
  }
  return mass > 0 ? std::hypot(momentum.x, momentum.y, momentum.z) / mass : 0;
}

}  // namespace talus::solver
