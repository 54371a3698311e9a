// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/boundary/contact_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "common/error.hpp"

namespace talus::solver {
namespace {

/// A place in cells from node (0, 0, 0), with the surface there.
struct Sample {
  double at[3];
  Vec3<double> normal;
  double area;
  int body;
};

bool open_at(const GridShape& shape, const TerrainTables& terrain, double xi, double eta) {
  const int i = static_cast<int>(std::floor(xi + 0.5)), j = static_cast<int>(std::floor(eta + 0.5));
  return i >= 0 && j >= 0 && i < shape.columns && j < shape.rows && terrain.open[shape.index(i, j)];
}

/// Which way a piece of surface looks along each axis (-1, 1), or neither (0). Faces along the axes and halfway between
/// them are far from where one way becomes another.
std::array<int, 3> facing(const Vec3<double>& area) {
  const double turn = 0.4 * length(area);
  const auto way = [&](double along) { return (along > turn ? 1 : 0) - (along < -turn ? 1 : 0); };
  return {way(area.x), way(area.y), way(area.z)};
}

/// The facets of a surface in half a cell that look the same way.
struct Bin {
  double area = 0, at[3] = {};
  Vec3<double> sum;
};
using Bins = std::map<std::array<std::array<int, 3>, 2>, Bin>;

/// Adds `share` of a facet to the half cell that it lies in. Between two of them it belongs to the one that it looks
/// into, else to both: a mirrored surface gives the mirrored points.
void add_facet(Bins& bins, const Sample& facet, double share, std::array<int, 3> half_cell, int axis) {
  if (axis == 3) {
    Bin& bin = bins[{half_cell, facing(facet.normal)}];
    bin.area += share * facet.area;
    bin.sum += facet.normal * (share * facet.area);
    for (int a = 0; a < 3; ++a) bin.at[a] += share * facet.area * facet.at[a];
    return;
  }
  constexpr double no_side = 1e-3;
  const double place = 2 * facet.at[axis], border = std::round(place);
  const int way = facing(facet.normal)[static_cast<std::size_t>(axis)];
  const bool between = std::abs(place - border) < no_side;
  const auto go_on = [&](double low_side, double part) {
    half_cell[static_cast<std::size_t>(axis)] = static_cast<int>(low_side);
    add_facet(bins, facet, part, half_cell, axis + 1);
  };
  if (!between) return go_on(std::floor(place), share);
  if (way != 0) return go_on(way > 0 ? border : border - 1, share);
  go_on(border - 1, share / 2);
  go_on(border, share / 2);
}

/// The facets above the ground, those of half a cell that look one way as one: both faces of a thin wall stay apart.
Bins exposed_facets(const MapGrid& map, const GridShape& shape, const TerrainTables& terrain,
                    const BodySurface& surface) {
  Bins bins;
  for (const Facet& facet : surface.facets) {
    const double xi = (facet.centre[0] - map.west) / shape.spacing - 0.5,
                 eta = (facet.centre[1] - map.south) / shape.spacing - 0.5;
    if (!open_at(shape, terrain, xi, eta)) continue;
    const double under = terrain.datum + terrain_at(shape, terrain, xi, eta),
                 bottom = shape.mapping == Mapping::cartesian ? terrain.datum : under;
    const Vec3<double> area{facet.area[0], facet.area[1], facet.area[2]};
    const double size = length(area);
    if (facet.centre[2] < under || !(size > 0)) continue;
    add_facet(bins, {{xi, eta, (facet.centre[2] - bottom) / shape.layer_height}, area * (1 / size), size, 0}, 1, {}, 0);
  }
  return bins;
}

[[noreturn]] void refuse_hidden(const MapGrid& map, const Obstacle& o, const BodySurface& surface) {
  throw DataError(
      {fmt::format("{}: the obstacle \"{}\" stands nowhere above the ground of the scene", o.level_set.string(),
                   o.name),
       fmt::format("it reaches from ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}); the scene from ({:.1f}, "
                   "{:.1f}) to ({:.1f}, {:.1f})",
                   surface.low[0], surface.low[1], surface.low[2], surface.high[0], surface.high[1], surface.high[2],
                   map.west, map.south, map.west + map.columns * map.cell, map.south + map.rows * map.cell),
       "Give the level set in the map's coordinates [m], elevations in the terrain's datum"});
}

/// The contact points of an obstacle, one for each half cell and way to look; returns what there is to say of them.
std::string add_obstacle(const MapGrid& map, const GridShape& shape, const TerrainTables& terrain, const Obstacle& o,
                         int body, std::vector<Sample>& samples) {
  const double half = 0.5 * shape.spacing, half_layer = 0.5 * shape.layer_height;
  const std::array<double, 3> largest{half, half, half_layer};
  const BodySurface surface = o.body ? surface_of(*o.body, largest) : read_level_set(o.level_set, o.grid, largest);
  double exposed = 0;
  std::size_t points = 0;
  for (const auto& [key, bin] : exposed_facets(map, shape, terrain, surface)) {
    const double size = length(bin.sum);
    if (!(size > 1e-9 * bin.area) || !(bin.area > 0)) continue;
    samples.push_back(
        {{bin.at[0] / bin.area, bin.at[1] / bin.area, bin.at[2] / bin.area}, bin.sum * (1 / size), size, body});
    exposed += bin.area;
    ++points;
  }
  if (points == 0) refuse_hidden(map, o, surface);
  return fmt::format("obstacle {}: {:.4g} m3, {:.4g} m2 above the ground, {} contact points", o.name, surface.volume,
                     exposed, points);
}

}  // namespace

ContactPoints make_contact_points(const MapGrid& map, const GridShape& shape, const TerrainTables& terrain,
                                  const std::vector<Obstacle>& obstacles) {
  ContactPoints points;
  std::vector<Sample> samples;
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    points.notes.push_back(add_obstacle(map, shape, terrain, obstacles[o], static_cast<int>(o), samples));
    points.friction.push_back(obstacles[o].friction);
  }
  const int blocks_x = blocks_across(shape.columns);
  const auto node = [](double position) { return static_cast<int>(std::floor(position + 0.5)); };
  const auto key = [&](std::size_t s) {
    return home_key(blocks_x, node(samples[s].at[0]), node(samples[s].at[1]), node(samples[s].at[2]));
  };
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (const std::size_t s : order) {
    for (std::size_t a = 0; a < 3; ++a) {
      const int nearest = node(samples[s].at[a]);
      points.cell[a].push_back(nearest);
      points.offset[a].push_back(samples[s].at[a] - nearest);
    }
    points.normal.push_back(samples[s].normal);
    points.area.push_back(samples[s].area);
    points.body.push_back(samples[s].body);
  }
  return points;
}

}  // namespace talus::solver
