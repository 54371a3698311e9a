// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/hdf5.hpp"

namespace talus::validation {
namespace {

struct Columns {
  std::vector<double> position;
  std::vector<float> velocity, volume, pressure;
  std::vector<std::int32_t> id;
};

Columns read_columns(const h5::File& file) {
  const auto whole = [&](const std::string& name, auto kind) {
    return file.read<decltype(kind)>("/VTKHDF/" + name, file.dims("/VTKHDF/" + name));
  };
  return {whole("Points", 0.0), whole("PointData/velocity", 0.0F), whole("PointData/volume", 0.0F),
          whole("PointData/pressure", 0.0F), whole("PointData/id", std::int32_t{})};
}

Points frame_of(const Columns& c, std::size_t first, std::size_t count, std::size_t points) {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  Points frame;
  frame.position.assign(points, {nowhere, nowhere, nowhere});
  frame.velocity.assign(points, {});
  frame.volume.assign(points, 0);
  frame.pressure.assign(points, 0);
  for (std::size_t p = first; p < first + count; ++p) {
    const auto id = static_cast<std::size_t>(c.id[p]);
    for (std::size_t a = 0; a < 3; ++a) {
      frame.position[id][a] = c.position[3 * p + a];
      frame.velocity[id][a] = c.velocity[3 * p + a];
    }
    frame.volume[id] = c.volume[p];
    frame.pressure[id] = c.pressure[p];
  }
  return frame;
}

}  // namespace

std::vector<Points> read_points(const std::filesystem::path& run) {
  const auto file = h5::File::open(run, {run, "Run talus-solve again"});
  if (!file.exists("/VTKHDF/Steps/Values")) return {};
  const auto times = file.read<double>("/VTKHDF/Steps/Values", file.dims("/VTKHDF/Steps/Values"));
  const auto counts = file.read<std::int64_t>("/VTKHDF/NumberOfPoints", file.dims("/VTKHDF/NumberOfPoints"));
  const Columns columns = read_columns(file);
  const auto last = std::max_element(columns.id.begin(), columns.id.end());
  const std::size_t points = last == columns.id.end() ? 0 : static_cast<std::size_t>(*last) + 1;
  std::vector<Points> frames;
  std::size_t first = 0;
  for (std::size_t f = 0; f < times.size(); ++f) {
    const auto count = static_cast<std::size_t>(counts.at(f));
    frames.push_back(frame_of(columns, first, count, points));
    frames.back().time = times[f];
    first += count;
  }
  return frames;
}

double front_of(const Points& points, double cell, double point_spacing) {
  std::vector<double> x;
  for (const auto& p : points.position) {
    if (std::isfinite(p[0])) x.push_back(p[0]);
  }
  std::sort(x.begin(), x.end());
  double front = 0;
  for (const double at : x) {
    if (at > front + cell + point_spacing) break;
    front = at;
  }
  return front + 0.5 * point_spacing;
}

double reach_of(const Points& points) {
  std::vector<double> x;
  for (const auto& p : points.position) {
    if (std::isfinite(p[0])) x.push_back(p[0]);
  }
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(x.size()));
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

}  // namespace talus::validation
