// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/sections.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/map/raster.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "solver/state/parts.hpp"

namespace talus::solver {

double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

int crossing(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& from,
             const std::array<double, 2>& to) {
  if (std::max(from[0], to[0]) < std::min(a[0], b[0]) || std::min(from[0], to[0]) > std::max(a[0], b[0]) ||
      std::max(from[1], to[1]) < std::min(a[1], b[1]) || std::min(from[1], to[1]) > std::max(a[1], b[1]))
    return 0;
  const bool was_left = turn(a, b, from) >= 0, is_left = turn(a, b, to) >= 0;
  if (was_left == is_left) return 0;
  if ((turn(from, to, a) >= 0) == (turn(from, to, b) >= 0)) return 0;  // passes beside the piece
  return was_left ? 1 : -1;
}

double distance(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& place) {
  const double x = b[0] - a[0], y = b[1] - a[1];
  const double along = ((place[0] - a[0]) * x + (place[1] - a[1]) * y) / (x * x + y * y);
  const double share = std::clamp(along, 0.0, 1.0);
  return std::hypot(place[0] - a[0] - share * x, place[1] - a[1] - share * y);
}

namespace {

constexpr Column<SectionReading> section_columns[] = {
    {"discharge_m3_s", "m3 s-1", [](const SectionReading& r) { return r.discharge; }, "discharge"},
    {"passed_m3", "m3", [](const SectionReading& r) { return r.passed; }, "volume that passed"},
    {"momentum_flux_N", "N", [](const SectionReading& r) { return r.force; }, "momentum flux"},
    {"thickness_max_m", "m", [](const SectionReading& r) { return r.thickness; }, "largest thickness"},
    {"area_m2", "m2", [](const SectionReading& r) { return r.area; }, "area of the section"},
    {"speed_m_s", "m s-1", [](const SectionReading& r) { return r.speed; }, "mean speed"},
    {"unseen_m3", "m3", [](const SectionReading& r) { return r.unseen; }, "volume that left unseen"},
};
constexpr double gone = -2;  ///< in the place of an easting, which is never below -1/2 [cells]

std::string section_prefix(const std::string& name) { return prefix_of("section", name); }

void check_lines(const std::vector<SectionOptions>& sections, const MapGrid& map) {
  std::vector<Fault> faults;
  for (const SectionOptions& s : sections) {
    for (const auto& [x, y] : s.line) {
      if (x >= map.x(0) && x <= map.x(map.columns - 1) && y >= map.y(0) && y <= map.y(map.rows - 1)) continue;
      faults.push_back({fmt::format("[[solve.section]] name = \"{}\": ({}, {}) lies outside the domain", s.name, x, y),
                        "nothing is computed there",
                        fmt::format("Choose x from {} to {} and y from {} to {}", map.x(0), map.x(map.columns - 1),
                                    map.y(0), map.y(map.rows - 1))});
      break;
    }
  }
  if (!faults.empty()) throw RecipeError(std::move(faults));
}

/// This function calls visit(a, b) for every piece of a line.
template <class Places, class Visit>
void each_piece(const Places& places, Visit&& visit) {
  for (std::size_t i = 1; i < places.size(); ++i) visit(places[i - 1], places[i]);
}

double distance_to(const std::vector<std::array<double, 2>>& places, const std::array<double, 2>& place) {
  double least = 1e300;
  each_piece(places, [&](const auto& a, const auto& b) { least = std::min(least, distance(a, b, place)); });
  return least;
}

/// Whether a path lies beside a box.
bool beside(const std::array<double, 2>& from, const std::array<double, 2>& to, const std::array<double, 2>& low,
            const std::array<double, 2>& high) {
  return std::max(from[0], to[0]) < low[0] || std::min(from[0], to[0]) > high[0] || std::max(from[1], to[1]) < low[1] ||
         std::min(from[1], to[1]) > high[1];
}

/// What a path does with the copies of a line, their mean.
struct Passage {
  double times = 0;  ///< crossings from left to right less those back
  double way = 0;    ///< the part of the path across the pieces that it crosses, that way [cells]
};

Passage passage_of(const std::vector<std::vector<std::array<double, 2>>>& copies, const std::array<double, 2>& from,
                   const std::array<double, 2>& to) {
  Passage passage;
  for (const auto& copy : copies) {
    each_piece(copy, [&](const auto& a, const auto& b) {
      const int times = crossing(a, b, from, to);
      if (times == 0) return;
      const double x = b[0] - a[0], y = b[1] - a[1];
      passage.times += times;
      passage.way += times * ((to[0] - from[0]) * y - (to[1] - from[1]) * x) / std::hypot(x, y);
    });
  }
  const auto count = static_cast<double>(copies.size());
  return {passage.times / count, passage.way / count};
}

std::array<double, 2> place_of(const ParticleState& points, std::size_t p) {
  return {points.cell[0][p] + points.offset[0][p], points.cell[1][p] + points.offset[1][p]};
}

}  // namespace

SectionRecorder::SectionRecorder(const SolveOptions& options, const Scene& scene)
    : TableRecorder(section_columns, places_of("section", options.sections)),
      map_(scene.map),
      densities_{options.material.density},
      volumes_(scene.points.volume.begin(), scene.points.volume.end()),
      readings_(options.sections.size()),
      inflow_(scene.inflow),
      seeded_(scene.points.size()) {
  volumes_.insert(volumes_.end(), inflow_.points.volume.begin(), inflow_.points.volume.end());
  check_lines(options.sections, map_);
  for (const PartOptions& part : options.parts) densities_.push_back(part.material.density);
  for (const SectionOptions& s : options.sections) lines_.push_back(line_of(s, map_));
}

/// The line of a section on the grid, with its copies across the way from its first point to its last.
SectionRecorder::Line SectionRecorder::line_of(const SectionOptions& options, const MapGrid& map) {
  Line line{options.name, {}, {}, {1e300, 1e300}, {-1e300, -1e300}};
  for (const auto& [x, y] : options.line) {
    const MapPlace place = in_cells(map, x, y);
    line.places.push_back({place[0] + off_lattice[0], place[1] + off_lattice[1]});
  }
  const MapPlace& first = line.places.front();
  const bool closed = std::hypot(line.places.back()[0] - first[0], line.places.back()[1] - first[1]) < 1e-6;
  const MapPlace& last = closed ? line.places[1] : line.places.back();
  const double x = last[0] - first[0], y = last[1] - first[1], length = std::hypot(x, y);
  for (int copy = 0; copy < copies; ++copy) {
    const double shift = (copy + 0.5) / copies - 0.5;
    line.copies.push_back(line.places);
    for (MapPlace& place : line.copies.back()) {
      place[0] += shift * y / length;
      place[1] -= shift * x / length;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        line.low[axis] = std::min(line.low[axis], place[axis]);
        line.high[axis] = std::max(line.high[axis], place[axis]);
      }
    }
  }
  return line;
}

void SectionRecorder::record(const Instant& now, RunHistory& history) {
  const std::vector<double>& time = history.at("time_s").values;
  const std::size_t row = history.at(section_prefix(lines_[0].name) + "passed_m3").values.size();
  const double since = row > 0 ? now.time - time[row - 1] : 0;
  const double fastest = static_cast<double>(positive_from_bits(now.clock.control.fastest_bits));
  const ParticleState points = now.solver.shown();
  const std::vector<double> thickness = now.solver.thickness();
  const std::size_t entered = inflow_.points_in(now.counted.pulses);
  const Moment moment{points, since, fastest * since / map_.cell, seeded_ + entered};
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    SectionReading& reading = readings_[i];
    const auto before = [&](const char* column) {
      return row > 0 ? history.at(section_prefix(lines_[i].name) + column).values[row - 1] : 0;
    };
    reading = {.passed = before("passed_m3"), .unseen = before("unseen_m3")};
    count(lines_[i], moment, reading);
    count_unseen(lines_[i], moment, reading);
    measure_surface(lines_[i], thickness, reading);
    measure_speed(lines_[i], points, reading);
  }
  follow(moment);
  expect_inflow(entered);
  TableRecorder::record(now, history);
}

/// The method takes the places of the points for those of the last record.
void SectionRecorder::follow(const Moment& moment) {
  x_.assign(smallest_parts * volumes_.size(), gone);
  y_.assign(x_.size(), gone);
  for (std::size_t p = 0; p < moment.points.size(); ++p) {
    if (moment.points.cell[0][p] < 0) continue;  // has left the domain
    const MapPlace place = place_of(moment.points, p);
    const auto [first, count] = parts_of(moment.points, p);
    std::fill_n(x_.begin() + static_cast<std::ptrdiff_t>(first), count, place[0]);
    std::fill_n(y_.begin() + static_cast<std::ptrdiff_t>(first), count, place[1]);
  }
}

/// The method takes the line for the place of what is to enter after the first `entered` points.
void SectionRecorder::expect_inflow(std::size_t entered) {
  for (std::size_t p = entered; p < inflow_.points.size(); ++p) {
    const auto first = static_cast<std::ptrdiff_t>(smallest_parts * (seeded_ + p));
    std::fill_n(x_.begin() + first, smallest_parts, inflow_.line_x[p]);
    std::fill_n(y_.begin() + first, smallest_parts, inflow_.line_y[p]);
  }
}

/// The method counts what crossed a line: its volume, and the momentum across the line by the mean velocity on the way.
void SectionRecorder::count(const Line& line, const Moment& moment, SectionReading& reading) const {
  if (x_.empty() || !(moment.since > 0)) return;
  double volume = 0, momentum = 0;
  for (std::size_t p = 0; p < moment.points.size(); ++p) {
    if (moment.points.cell[0][p] < 0) continue;
    const std::size_t part = parts_of(moment.points, p).first;
    const MapPlace from{x_[part], y_[part]}, to = place_of(moment.points, p);
    if (from[0] <= gone || beside(from, to, line.low, line.high)) continue;
    const Passage passage = passage_of(line.copies, from, to);
    volume += passage.times * moment.points.volume[p];
    momentum += passage.way * map_.cell * mass_of(moment.points, p) / moment.since;
  }
  reading.passed += volume;
  reading.discharge = volume / moment.since;
  reading.force = momentum / moment.since;
}

/// The method counts what left the domain from so near to a line that it may have crossed it on the way out.
void SectionRecorder::count_unseen(const Line& line, const Moment& moment, SectionReading& reading) const {
  if (x_.empty()) return;
  std::vector<bool> here(x_.size());
  for (std::size_t p = 0; p < moment.points.size(); ++p) {
    const auto [first, count] = parts_of(moment.points, p);
    std::fill_n(here.begin() + static_cast<std::ptrdiff_t>(first), count, moment.points.cell[0][p] >= 0);
  }
  for (std::size_t part = 0; part < smallest_parts * moment.known; ++part) {
    if (here[part] || x_[part] <= gone || distance_to(line.places, {x_[part], y_[part]}) > moment.reach) continue;
    reading.unseen += volumes_[part / smallest_parts] / smallest_parts;
  }
}

/// The method measures thickness along a line, at every half cell.
void SectionRecorder::measure_surface(const Line& line, const std::vector<double>& thickness,
                                      SectionReading& reading) const {
  const Raster map{map_, thickness};
  each_piece(line.places, [&](const MapPlace& a, const MapPlace& b) {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length)));
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const double h = bilinear(map, map_.x(0) + (a[0] + share * (b[0] - a[0])) * map_.cell,
                                map_.y(0) + (a[1] + share * (b[1] - a[1])) * map_.cell);
      if (!std::isfinite(h)) continue;
      reading.thickness = std::max(reading.thickness, h);
      sum += (i == 0 || i == steps ? 0.5 : 1) * h;
    }
    reading.area += sum / steps * length * map_.cell;
  });
}

/// The method measures the mean velocity about a line: points count by mass and by a hat as wide as a cell.
void SectionRecorder::measure_speed(const Line& line, const ParticleState& points, SectionReading& reading) const {
  double mass = 0;
  Vec3<double> momentum{};
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.cell[0][p] < 0) continue;
    const double share = (1 - distance_to(line.places, place_of(points, p))) * mass_of(points, p);
    if (!(share > 0)) continue;
    mass += share;
    momentum += Vec3<double>{points.velocity[0][p], points.velocity[1][p], points.velocity[2][p]} * share;
  }
  reading.speed = mass > 0 ? std::hypot(momentum.x, momentum.y, momentum.z) / mass : 0;
}

void SectionRecorder::keep(RunMemory& memory) const {
  memory.section_x = x_;
  memory.section_y = y_;
}

void SectionRecorder::restore(const RunMemory& memory) {
  const std::size_t parts = smallest_parts * volumes_.size();
  if (memory.section_x.size() != parts || memory.section_y.size() != parts)
    throw DataError({fmt::format("the checkpoint holds the places of {} parts of points for sections, the scene has {}",
                                 memory.section_x.size(), parts),
                     "it is of another version of this program", "Run talus-solve again without --restart"});
  x_ = memory.section_x;
  y_ = memory.section_y;
}

void SectionRecorder::conclude(const RunHistory& history) const {
  const std::vector<double>& time = history.at("time_s").values;
  for (const Line& line : lines_) {
    const auto& passed = history.at(section_prefix(line.name) + "passed_m3").values;
    const auto& discharge = history.at(section_prefix(line.name) + "discharge_m3_s").values;
    const auto most = std::max_element(discharge.begin(), discharge.end(),
                                       [](double a, double b) { return std::abs(a) < std::abs(b); });
    log_info(fmt::format("section {}: {:.4g} m3 passed, largest mean discharge {:.4g} m3/s until t = {:.2f} s",
                         line.name, passed.back(), *most, time[static_cast<std::size_t>(most - discharge.begin())]));
    const double unseen = history.at(section_prefix(line.name) + "unseen_m3").values.back();
    if (!(unseen > 0)) continue;
    warn("passed-unseen",
         fmt::format("section {}: {:.4g} m3 left the domain so near to it that they may have crossed it unseen. Move "
                     "the section away from the edge of the domain, or take a larger domain",
                     line.name, unseen),
         {{"volume", unseen, "m3"}});
  }
}

}  // namespace talus::solver
