// B5: a dam break on a slope.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

constexpr double degree = std::numbers::pi / 180, slope = 22 * degree, bed = 21 * degree;
constexpr double height = 1.08;                          // of the dam, upright [m]
constexpr double west = -30, east = 36;                  // along the slope: what the upper end of the reservoir does not reach [m]

/// Thickness across the slope and discharge along it, at the columns of the grid.
struct Profile {
  std::vector<double> x, thickness, discharge;  // x along the slope [m], [m], [m2/s]
};

/// From the points, each spread over the two columns beside it.
Profile profile_of(const Points& points, double cell) {
  Profile p;
  const double along = std::cos(slope);
  const long first = std::lround(std::ceil(west * along / cell)), last = std::lround(std::floor(east * along / cell));
  const auto count = static_cast<std::size_t>(last - first + 1);
  p.thickness.assign(count, 0);
  p.discharge.assign(count, 0);
  for (std::size_t c = 0; c < count; ++c) p.x.push_back((static_cast<double>(first) + static_cast<double>(c)) * cell / along);
  for (std::size_t q = 0; q < points.size(); ++q) {
    const double place = points.position[q][0] / cell, speed = static_cast<double>(points.velocity[q][0]) * along - static_cast<double>(points.velocity[q][2]) * std::sin(slope);
    const double volume = static_cast<double>(points.volume[q]) * along / (cell * cell);  // of a slice one cell deep
    const long left = std::lround(std::floor(place));
    for (const long column : {left, left + 1}) {
      if (column < first || column > last) continue;
      const double share = volume * (1 - std::abs(place - static_cast<double>(column)));
      p.thickness[static_cast<std::size_t>(column - first)] += share;
      p.discharge[static_cast<std::size_t>(column - first)] += share * speed;
    }
  }
  return p;
}

struct Norms {
  double mean = 0, most = 0;  // root of the mean square over that of the reference; largest over the largest
};

Norms norms(const std::vector<double>& computed, const std::vector<double>& exact) {
  double square = 0, size = 0, most = 0, largest = 0;
  for (std::size_t c = 0; c < exact.size(); ++c) {
    const double d = computed[c] - exact[c];
    square += d * d;
    size += exact[c] * exact[c];
    most = std::max(most, std::abs(d));
    largest = std::max(largest, std::abs(exact[c]));
  }
  return {std::sqrt(square / size), most / largest};
}

Profile exact_at(const std::vector<double>& x, double time) {
  const DamBreak dam{slope, bed, height * std::cos(slope)};
  Profile p;
  p.x = x;
  const double middle = 0.5 * height * std::sin(slope);  // the dam is upright: its face leans downhill against the slope
  for (const double at : x) {
    p.thickness.push_back(dam.thickness(at - middle, time));
    p.discharge.push_back(p.thickness.back() * dam.speed(at - middle, time));
  }
  return p;
}

}  // namespace

void dam_break(Bench& bench) {
  Chart thickness, errors;
  thickness.title = "B5: dam break on a slope after 5 s";
  thickness.x_label = "along the slope [m]";
  thickness.y_label = "thickness [m]";
  errors.title = "B5: error over layer height, cells four times as wide";
  errors.x_label = "layer height [m]";
  errors.y_label = "error, root mean square over the reference's";
  errors.log_x = errors.log_y = true;
  int colour = 1;
  for (const char* mapping : {"terrain-following", "cartesian"}) {
    std::vector<double> h, error;
    for (const int layers : {2, 4, 8}) {
      if (layers == 8 && !bench.complete()) continue;
      const double layer = height / layers, cell = 4 * layer;
      const Outcome o = bench.run(fmt::format("{}, {} layers", mapping, layers),
                                  {{"preprocess.grid.spacing_m", cell},
                                   {"preprocess.grid.layer_height_m", layer},
                                   {"preprocess.laboratory.columns", whole(std::lround(100 / cell) + 8)},
                                   {"preprocess.laboratory.west_m", -54 - 3.5 * cell},
                                   {"preprocess.laboratory.south_m", -3.5 * cell},
                                   {"preprocess.box[0].north_m", cell},
                                   {"solve.mapping", words(mapping)},
                                   {"solve.wall[1].position_m", cell}});
      const auto nothing = std::numeric_limits<double>::quiet_NaN();
      Norms of_thickness{nothing, nothing}, of_discharge = of_thickness;
      if (o.ok()) {
        const Profile computed = profile_of(o.last(), cell), exact = exact_at(computed.x, o.last().time);
        of_thickness = norms(computed.thickness, exact.thickness);
        of_discharge = norms(computed.discharge, exact.discharge);
        Series s{fmt::format("{}, {} layers", mapping, layers), computed.x, computed.thickness, colour++};
        if (layers == 4) thickness.series.push_back(s);
      }
      bench.note(o, "thickness, root mean square", of_thickness.mean);
      bench.note(o, "thickness, largest", of_thickness.most);
      bench.note(o, "discharge, root mean square", of_discharge.mean);
      bench.note(o, "discharge, largest", of_discharge.most);
      h.push_back(layer);
      error.push_back(of_thickness.mean);
    }
    errors.series.push_back(convergence(mapping, h, error, colour++));
  }
  std::vector<double> x;
  for (double at = west; at <= east; at += 0.25) x.push_back(at);
  const Profile exact = exact_at(x, 5);
  thickness.series.insert(thickness.series.begin(), Series{"Mangeney et al. 2000", exact.x, exact.thickness, 0});
  bench.picture("B5-thickness", png_of(thickness));
  bench.picture("B5-convergence", png_of(errors));
}

}  // namespace talus::validation
