// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/make_inflow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

InflowSection::InflowSection(InflowGround ground, const InflowOptions& options)
    : ground_(std::move(ground)),
      sorted_(ground_.height),
      speed_(options.speed),
      depth_(options.depth),
      froude_(options.froude) {
  std::ranges::sort(sorted_);
}

double InflowSection::along() const { return std::sqrt(1 + ground_.slope * ground_.slope); }

SectionFlow InflowSection::filled_to(double level) const {
  SectionFlow flow{.level = level};
  for (const double height : sorted_) {
    if (!(height < level)) break;
    flow.area += (level - height) * ground_.strip;
    flow.width += ground_.strip;
  }
  flow.depth = std::max(0.0, level - sorted_.front());
  return flow;
}

/// Raises the surface strip by strip until the area is reached.
SectionFlow InflowSection::filled_by(double area) const {
  double sum = 0;
  for (std::size_t n = 1; n <= sorted_.size(); ++n) {
    sum += sorted_[n - 1];
    const auto count = static_cast<double>(n);
    const double level = (area / ground_.strip + sum) / count;
    if (n == sorted_.size() || level <= sorted_[n]) return filled_to(level);
  }
  return {};
}

/// Halves the range of levels: what passes grows with the level.
SectionFlow InflowSection::critical(double discharge, double froude) const {
  // u along the ground is Fr sqrt(g cos h_n), h_n = cos A / B; horizontally it is cos times as much.
  const double cosine = 1 / along(), factor = froude * cosine * cosine * std::sqrt(ground_.gravity);
  const auto passes = [&](const SectionFlow& f) {
    return f.width > 0 ? factor * f.area * std::sqrt(f.area / f.width) : 0.0;
  };
  double low = 0, high = ground_.strip;
  while (passes(filled_by(high)) < discharge) high *= 2;
  for (int halvings = 0; halvings < 200 && high - low > 1e-15 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (passes(filled_by(middle)) < discharge ? low : high) = middle;
  }
  return filled_by(high);
}

SectionFlow InflowSection::flow(double discharge) const {
  SectionFlow flow;
  if (speed_)
    flow = filled_by(discharge * along() / *speed_);
  else if (depth_)
    flow = filled_to(sorted_.front() + *depth_);
  else
    flow = critical(discharge, *froude_);
  flow.speed = discharge / flow.area;
  return flow;
}

std::vector<double> InflowSection::thickness(const SectionFlow& flow) const {
  std::vector<double> thickness;
  for (const double height : ground_.height) thickness.push_back(std::max(0.0, flow.level - height));
  return thickness;
}

double InflowSection::froude(const SectionFlow& flow) const {
  const double cosine = 1 / along();
  return flow.speed * along() / (cosine * std::sqrt(ground_.gravity * flow.area / flow.width));
}

namespace {

/// Ground that falls by less in the direction of a flow than this does not say which way it goes [-].
constexpr double level_ground = 1e-6;
/// The least angle between the flow and its line, as its sine [-]: 30 degrees.
constexpr double least_sine = 0.5;

CellPlace cells_of(const MapGrid& map, const std::array<double, 2>& at) {
  return {(at[0] - map.west) / map.cell - 0.5, (at[1] - map.south) / map.cell - 0.5};
}

void refuse_outside(const InflowOptions& o, const std::string& place, const MapGrid& map, std::size_t end) {
  throw RecipeError(
      {fmt::format("{}: ({}, {}) lies outside the known ground, or at its edge", place, o.line[end][0], o.line[end][1]),
       "what enters needs known ground one cell around it",
       fmt::format("Choose x from {} to {} and y from {} to {}, away from cells without elevation", map.x(1),
                   map.x(map.columns - 2), map.y(1), map.y(map.rows - 2))});
}

/// The flow's direction: as given, or across the line to the side where the ground falls.
CellPlace direction(const InflowOptions& o, const std::string& place, const CellPlace& across, double slope) {
  if (!o.azimuth) {
    if (std::abs(slope) > level_ground) return slope < 0 ? across : CellPlace{-across[0], -across[1]};
    throw RecipeError({fmt::format("{}: across its line the ground falls by {:.2g} on average", place, -slope),
                       "on level ground nothing says which way the flow goes",
                       "Give azimuth_deg, the direction of the flow from north over east"});
  }
  const double turn = *o.azimuth * (std::numbers::pi / 180);
  const CellPlace ahead{std::sin(turn), std::cos(turn)};
  const double sine = std::abs(ahead[0] * across[0] + ahead[1] * across[1]);
  if (sine >= least_sine) return ahead;
  throw RecipeError({fmt::format("{}: azimuth_deg = {:g} runs at {:.0f} deg to the line", place, *o.azimuth,
                                 std::asin(sine) * (180 / std::numbers::pi)),
                     "below 30 deg the line hardly lies across the flow",
                     "Turn the line across the flow, or leave azimuth_deg out"});
}

/// The end of the pulse that begins at `begin` [s]: when its flow has gone `way` [m], at the spell's end at the latest,
/// and there where less than half a way would be left for another one.
double pulse_end(const Hydrograph& hydrograph, const InflowSection& section, double way, double begin,
                 double spell_end) {
  const double before = hydrograph.volume_until(begin);
  const auto gone = [&](double end) {
    const double volume = hydrograph.volume_until(end) - before;
    return volume > 0 ? section.flow(volume / (end - begin)).speed * (end - begin) : 0.0;
  };
  if (!(gone(spell_end) > 1.5 * way)) return spell_end;
  double low = begin, high = spell_end;
  for (int halvings = 0; halvings < 100 && high - low > 1e-13 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (gone(middle) < way ? low : high) = middle;
  }
  return high;
}

}  // namespace

bool InflowTerrain::open(const CellPlace& at) const {
  const int i = static_cast<int>(std::floor(at[0] + 0.5)), j = static_cast<int>(std::floor(at[1] + 0.5));
  return i >= 0 && j >= 0 && i < shape.columns && j < shape.rows && terrain.open[shape.index(i, j)] != 0;
}

CellPlace InflowTerrain::slope(const CellPlace& at) const {
  const double i0 = std::clamp(std::floor(at[0]), 0.0, shape.columns - 2.0),
               j0 = std::clamp(std::floor(at[1]), 0.0, shape.rows - 2.0);
  const double a = at[0] - i0, b = at[1] - j0;
  const auto mean = [&](const std::vector<double>& slopes) {
    const auto value = [&](int i, int j) {
      return slopes[shape.index(static_cast<int>(i0) + i, static_cast<int>(j0) + j)];
    };
    return (1 - b) * ((1 - a) * value(0, 0) + a * value(1, 0)) + b * ((1 - a) * value(0, 1) + a * value(1, 1));
  };
  return {mean(terrain.slope_x), mean(terrain.slope_y)};
}

InflowLine inflow_line(const InflowOptions& o, const std::string& place, const MapGrid& map,
                       const InflowTerrain& terrain) {
  InflowLine line;
  line.from = cells_of(map, o.line[0]);
  line.to = cells_of(map, o.line[1]);
  for (std::size_t end = 0; end < 2; ++end)
    if (!terrain.open(end == 0 ? line.from : line.to)) refuse_outside(o, place, map, end);
  const double x = line.to[0] - line.from[0], y = line.to[1] - line.from[1], length = std::hypot(x, y);
  const int strips = std::max(1, static_cast<int>(std::lround(length * o.points_per_cell[1])));
  const CellPlace across{y / length, -x / length};  // to the right of the line
  double slope_x = 0, slope_y = 0;
  for (int s = 0; s < strips; ++s) {
    const double share = (s + 0.5) / strips;
    const CellPlace middle{line.from[0] + share * x, line.from[1] + share * y};
    if (!terrain.open(middle))
      throw RecipeError({fmt::format("{}: the ground is not known all along its line", place),
                         "what enters needs known ground one cell around it",
                         "Move the line, or fill the model's voids"});
    line.middles.push_back(middle);
    line.ground.height.push_back(terrain_at(terrain.shape, terrain.terrain, middle[0], middle[1]));
    slope_x += terrain.slope(middle)[0] / strips;
    slope_y += terrain.slope(middle)[1] / strips;
  }
  line.ahead = direction(o, place, across, slope_x * across[0] + slope_y * across[1]);
  line.ground.slope = slope_x * line.ahead[0] + slope_y * line.ahead[1];
  line.ground.strip = length * map.cell / strips * std::abs(line.ahead[0] * across[0] + line.ahead[1] * across[1]);
  return line;
}

std::vector<PulseTimes> pulse_times(const Hydrograph& hydrograph, const InflowSection& section, double way,
                                    double end_time) {
  std::vector<PulseTimes> pulses;
  double let_in = 0;
  for (const auto& [from, to] : hydrograph.spells()) {
    const double last = std::min(to, end_time);
    for (double begin = from; begin < last;) {
      const double end = pulse_end(hydrograph, section, way, begin, last), until = hydrograph.volume_until(end);
      if (until > let_in) pulses.push_back({begin, end, until - let_in});
      let_in = until;
      begin = end;
    }
  }
  return pulses;
}

struct InflowSeeder::Strip {
  CellPlace middle;      ///< on the line
  double thickness = 0;  ///< [m]
  double volume = 0;     ///< [m3]
  double way = 0;        ///< that the pulse has gone [m]
  double speed = 0;      ///< horizontal [m/s]
};

void InflowSeeder::add(const PulseTimes& times, const std::string& place, Inflow& inflow) const {
  const double duration = times.end - times.begin;
  const SectionFlow flow = section_.flow(times.volume / duration);
  const std::vector<double> thickness = section_.thickness(flow);
  const double all = std::accumulate(thickness.begin(), thickness.end(), 0.0);
  InflowPulse pulse{.time = times.end, .first = inflow.points.size(), .volume = times.volume};
  for (std::size_t s = 0; s < thickness.size(); ++s) {
    if (!(thickness[s] > 0)) continue;
    const double volume = times.volume * (thickness[s] / all);
    add_strip({line_.middles[s], thickness[s], volume, flow.speed * duration, flow.speed}, place, inflow);
  }
  pulse.count = inflow.points.size() - pulse.first;
  for (std::size_t p = pulse.first; p < inflow.points.size(); ++p) sum_up(inflow.points, p, pulse);
  inflow.pulses.push_back(pulse);
}

/// Lays the points of a strip between the line and where the pulse has come to.
void InflowSeeder::add_strip(const Strip& strip, const std::string& place, Inflow& inflow) const {
  const auto [along, across, up] = matter_.points_per_cell;
  const GridShape& shape = terrain_.shape;
  const auto count = [](double cells, int per_cell) {
    return std::max(1, static_cast<int>(std::lround(cells * per_cell)));
  };
  const int rows = count(strip.way / shape.spacing, along), layers = count(strip.thickness / shape.layer_height, up);
  Strip one = strip;
  one.volume /= static_cast<double>(rows) * layers;
  one.way /= rows;  // of a point
  for (int row = 0; row < rows; ++row) {
    const double way = (row + 0.5) * one.way;
    const CellPlace at{strip.middle[0] + way / shape.spacing * line_.ahead[0],
                       strip.middle[1] + way / shape.spacing * line_.ahead[1]};
    if (!terrain_.open(at))
      throw DataError({fmt::format("{}: {:.3g} m below its line the known ground ends", place, way),
                       "what enters needs known ground one cell around it", "Move the line up the flow"});
    for (int layer = 0; layer < layers; ++layer) add_point(one, way, (layer + 0.5) * strip.thickness / layers, inflow);
  }
}

/// Adds a point that has gone `way` and stands at `height` above the ground [m].
void InflowSeeder::add_point(const Strip& strip, double way, double height, Inflow& inflow) const {
  const GridShape& shape = terrain_.shape;
  ParticleState& s = inflow.points;
  const CellPlace at{strip.middle[0] + way / shape.spacing * line_.ahead[0],
                     strip.middle[1] + way / shape.spacing * line_.ahead[1]};
  const std::size_t p = s.size();
  const auto add = [](const ParticleField& field, int, auto& list) { list.push_back(field.initial); };
  visit_particle_fields(add, s);
  place_in_cells(at[0], s.cell[0][p], s.offset[0][p]);
  place_in_cells(at[1], s.cell[1][p], s.offset[1][p]);
  const double ground = shape.mapping == Mapping::cartesian ? terrain_at(shape, terrain_.terrain, at[0], at[1]) : 0;
  place_in_cells((height + ground) / shape.layer_height, s.cell[2][p], s.offset[2][p]);
  const CellPlace slope = terrain_.slope(at);
  s.velocity[0][p] = strip.speed * line_.ahead[0];
  s.velocity[1][p] = strip.speed * line_.ahead[1];
  s.velocity[2][p] = strip.speed * (slope[0] * line_.ahead[0] + slope[1] * line_.ahead[1]);
  s.volume[p] = strip.volume;
  const double side = std::sqrt(strip.way * line_.ground.strip);  // of a square of the same area along x and y
  s.extent[0][p] = s.extent[1][p] = side / shape.spacing;
  s.extent[2][p] = strip.volume / (side * side * shape.layer_height);
  lay_sides(s, p, shape, terrain_.terrain, side, side);
  s.release[p] = matter_.release;
  s.material[p] = matter_.material;
  inflow.line_x.push_back(strip.middle[0]);
  inflow.line_y.push_back(strip.middle[1]);
}

/// Adds a point to the sums of its pulse: momentum, and energy as energies() sum it up.
void InflowSeeder::sum_up(const ParticleState& s, std::size_t p, InflowPulse& pulse) const {
  const GridShape& shape = terrain_.shape;
  const double xi = s.cell[0][p] + s.offset[0][p], eta = s.cell[1][p] + s.offset[1][p];
  double z = (s.cell[2][p] + s.offset[2][p]) * shape.layer_height;
  if (shape.mapping == Mapping::terrain_following) z += terrain_at(shape, terrain_.terrain, xi, eta);
  const Vec3<double> v{s.velocity[0][p], s.velocity[1][p], s.velocity[2][p]}, &g = matter_.gravity;
  const double fall = g.x * xi * shape.spacing + g.y * eta * shape.spacing + g.z * z;
  const double mass = s.volume[p] * matter_.density;
  pulse.energy += mass * (0.5 * dot(v, v) - fall);
  pulse.momentum += v * mass;
}

}  // namespace talus::solver
