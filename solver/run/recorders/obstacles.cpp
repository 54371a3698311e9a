// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/obstacles.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
namespace talus::solver {
namespace {

constexpr Column<Vec3<double>> obstacle_columns[] = {
    {"impulse_x_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.x; }, "impulse towards the east"},
    {"impulse_y_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.y; }, "impulse towards the north"},
    {"impulse_z_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.z; }, "impulse upwards"},
};

std::string prefix_of(const std::string& name) { return "obstacle_" + name + "_"; }

std::vector<Place> places_of(const std::vector<ObstacleOptions>& obstacles) {
  std::vector<Place> places;
  places.reserve(obstacles.size());
  for (const ObstacleOptions& o : obstacles) places.push_back({prefix_of(o.name), "obstacle " + o.name});
  return places;
}

}  // namespace

ObstacleRecorder::ObstacleRecorder(const SolveOptions& options)
    : TableRecorder(obstacle_columns, places_of(options.obstacles)), interval_(options.history_interval) {
  for (const ObstacleOptions& o : options.obstacles) names_.push_back(o.name);
}

void ObstacleRecorder::conclude(const RunHistory& history) const {
  const std::vector<double>& time = history.at("time_s").values;
  for (const std::string& name : names_) {
    const std::vector<double>* impulse[3];
    for (int axis = 0; axis < 3; ++axis)
      impulse[axis] = &history.at(prefix_of(name) + obstacle_columns[axis].name).values;
    double peak = 0, when = 0;
    for (std::size_t row = 1; row < time.size(); ++row) {
      const double span = time[row] - time[row - 1];
      const auto change = [&](int axis) { return ((*impulse[axis])[row] - (*impulse[axis])[row - 1]) / span; };
      const double force = span > 0 ? std::hypot(change(0), change(1), change(2)) : 0;
      if (force > peak) when = time[row];
      peak = std::max(peak, force);
    }
    log_info(fmt::format(
        "obstacle {}: impulse ({:.4g}, {:.4g}, {:.4g}) N s, largest mean force over {:g} s {:.4g} N until t = {:.2f} s",
        name, impulse[0]->back(), impulse[1]->back(), impulse[2]->back(), interval_, peak, when));
  }
}

}  // namespace talus::solver
