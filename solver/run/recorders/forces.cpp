// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::solver {
namespace {

struct Direction {
  const char* force;     ///< column of this recorder
  const char* momentum;  ///< column of the run's own
  const char* entered;   ///< column of the momentum that inflows brought, where there are any
};
constexpr Direction directions[] = {{"ground_force_x_N", "momentum_x_kg_m_s", "inflow_momentum_x_kg_m_s"},
                                    {"ground_force_y_N", "momentum_y_kg_m_s", "inflow_momentum_y_kg_m_s"},
                                    {"ground_force_z_N", "momentum_z_kg_m_s", "inflow_momentum_z_kg_m_s"}};

constexpr Column<Vec3<double>> obstacle_columns[] = {
    {"impulse_x_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.x; }, "impulse towards the east"},
    {"impulse_y_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.y; }, "impulse towards the north"},
    {"impulse_z_N_s", "N s", [](const Vec3<double>& impulse) { return impulse.z; }, "impulse upwards"},
};

}  // namespace

void GroundForceRecorder::add_columns(RunHistory& history) const {
  for (const Direction& d : directions)
    history.columns.push_back({.name = d.force, .unit = "N", .quantity = "", .place = "", .values = {}});
}

void GroundForceRecorder::record(const Instant& now, RunHistory& history) {
  const std::vector<double>& time = history.at("time_s").values;
  const std::vector<double>& outflow = history.at("outflow_m3").values;
  for (const Direction& d : directions) {
    // The rows of the run's own columns may be one ahead already: the last before `now` is counted by our own.
    std::vector<double>& forces = history.at(d.force).values;
    const std::vector<double>& momentum = history.at(d.momentum).values;
    const std::size_t row = forces.size();
    double force = 0;
    if (row > 0 && row < momentum.size()) {
      const double span = now.time - time[row - 1];
      const HistoryColumn* const in = history.find(d.entered);  // what enters was given its momentum elsewhere
      const double entered = in ? in->values[row] - in->values[row - 1] : 0;
      force = span > 0 ? -(momentum[row] - momentum[row - 1] - entered) / span : 0;
      if (outflow[row] != outflow[row - 1]) force = std::numeric_limits<double>::quiet_NaN();
    }
    forces.push_back(force);
  }
}

void GroundForceRecorder::conclude(const RunHistory& history) const {
  const auto& time = history.at("time_s").values;
  double most = 0, when = 0;
  for (std::size_t row = 0; row < time.size(); ++row) {
    const auto force = [&](int i) { return history.at(directions[i].force).values[row]; };
    const double size = std::hypot(force(0), force(1), force(2));
    if (!(size > most)) continue;  // NaN is not
    most = size;
    when = time[row];
  }
  if (most > 0)
    log_info(
        fmt::format("largest force on the ground beyond the weight at rest: {:.4g} N until t = {:.2f} s", most, when));
  const auto& forces = history.at(directions[0].force).values;
  const auto without = std::count_if(forces.begin(), forces.end(), [](double f) { return std::isnan(f); });
  if (without == 0) return;
  warn("unknown-ground-force",
       fmt::format("the force on the ground is not known in {} of {} records, in whose time matter left the domain. "
                   "Take a larger domain",
                   without, forces.size()),
       {{"records", static_cast<double>(without), "1"}});
}

ObstacleRecorder::ObstacleRecorder(const SolveOptions& options)
    : TableRecorder(obstacle_columns, places_of("obstacle", options.obstacles)), interval_(options.history_interval) {
  for (const ObstacleOptions& o : options.obstacles) names_.push_back(o.name);
}

void ObstacleRecorder::conclude(const RunHistory& history) const {
  const std::vector<double>& time = history.at("time_s").values;
  for (const std::string& name : names_) {
    const std::vector<double>* impulse[3];
    for (int axis = 0; axis < 3; ++axis)
      impulse[axis] = &history.at(prefix_of("obstacle", name) + obstacle_columns[axis].name).values;
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
