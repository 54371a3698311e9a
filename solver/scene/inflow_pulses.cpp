// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/inflow_pulses.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "common/error.hpp"
#include "solver/scene/place_in_cells.hpp"

namespace talus::solver {
namespace {

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

/// One strip of a pulse.
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

/// The method lays the points of a strip between the line and where the pulse has come to.
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

/// The method adds a point that has gone `way` and stands at `height` above the ground [m].
void InflowSeeder::add_point(const Strip& strip, double way, double height, Inflow& inflow) const {
  const GridShape& shape = terrain_.shape;
  ParticleState& s = inflow.points;
  const CellPlace at{strip.middle[0] + way / shape.spacing * line_.ahead[0],
                     strip.middle[1] + way / shape.spacing * line_.ahead[1]};
  const std::size_t p = s.size();
  visit_particle_fields([](const ParticleField& field, int, auto& list) { list.push_back(field.initial); }, s);
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
  s.release[p] = matter_.release;
  s.material[p] = matter_.material;
  inflow.line_x.push_back(strip.middle[0]);
  inflow.line_y.push_back(strip.middle[1]);
}

/// The method adds a point to the sums of its pulse: momentum, and energy as energies() sum it up.
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
