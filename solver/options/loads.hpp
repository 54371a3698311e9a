// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gravity, the velocity at the start, and forces on parts of the mass.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/parallel/math.hpp"

namespace talus::solver {

/// The keys of [solve] for gravity and the velocity at the start.
struct GravityOptions {
  std::vector<double> gravity = {0, 0, -9.81};       ///< [m/s2]
  double gravity_ramp = 0;                           ///< time over which it grows to its full size [s]
  std::vector<double> initial_velocity = {0, 0, 0};  ///< [m/s]

  Vec3<double> gravity_vector() const { return {gravity[0], gravity[1], gravity[2]}; }
  double gravity_size() const { return std::hypot(gravity[0], gravity[1], gravity[2]); }
  double initial_speed() const { return std::hypot(initial_velocity[0], initial_velocity[1], initial_velocity[2]); }

  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    v.numbers("gravity_m_s2", gravity, recipe::any, "gravity: east, north, up");
    need_three(v, "gravity_m_s2", gravity);
    v.number("gravity_ramp_s", gravity_ramp, recipe::not_negative, "time over which gravity grows to its full size");
    v.numbers("initial_velocity_m_s", initial_velocity, recipe::any,
              "velocity of the whole mass at the start: east, north, up");
    need_three(v, "initial_velocity_m_s", initial_velocity);
  }

 private:
  static void need_three(recipe::Visitor& v, const char* key, const std::vector<double>& values) {
    v.needs(values.size() == 3,
            {"[solve] " + std::string(key) + " has " + std::to_string(values.size()) + " numbers",
             "it is a vector: east, north, up", "Give three: " + std::string(key) + " = [0.0, 0.0, 0.0]"});
  }
};

/// The keys of [[solve.load]]: a force on the points that start inside a box.
struct LoadOptions {
  std::vector<double> extent = {0, 0, 0, 0, 0, 0};  ///< west, south, east, north [m], bottom, top above the ground [m]
  std::vector<double> force = {0, 0, 0};            ///< in all [N]
  double ramp = 0;                                  ///< time over which it grows [s]
  double from = 0, to = 1e30;                       ///< [s]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    v.numbers("extent_m", extent, recipe::any,
              "[west, south, east, north, bottom, top], the last two above the ground: points starting there");
    v.numbers("force_N", force, recipe::any, "force on them in all: east, north, up");
    v.needs(extent.size() == 6 && force.size() == 3,
            {"[[solve.load]] extent_m or force_N has the wrong number of values", "a box has six, a force three",
             "Give extent_m = [west, south, east, north, bottom, top] and force_N = [east, north, up]"});
    v.number("ramp_s", ramp, recipe::not_negative, "time over which it grows to its full size");
    recipe::fixed_list<double>(v, "during_s", {&from, &to}, recipe::not_negative,
                               "it pulls from the one time to the other", "[[solve.load]]");
  }
};

}  // namespace talus::solver
