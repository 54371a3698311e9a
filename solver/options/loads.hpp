// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What acts on the mass: gravity, forces on parts of it, the shaking of the ground, walls and obstacles.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/domain/level_set.hpp"
#include "common/recipe/recipe.hpp"
#include "solver/boundary/walls.hpp"
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

struct Shaking;
struct SolveOptions;

enum class ShakingUnit { m_s2, g, cm_s2 };

/// The keys of [solve.shaking].
struct ShakingOptions {
  std::filesystem::path file;  ///< empty: the ground rests
  ShakingUnit unit = ShakingUnit::m_s2;
  double scale = 1;                            ///< of the accelerations [-]
  double start = 0;                            ///< of the first row [s]
  std::optional<double> azimuth;               ///< of the column `along`, from north over east [deg]
  std::shared_ptr<const Shaking> record = {};  ///< instead of a file, as it acts; no key

  bool acts() const { return record || !file.empty(); }
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

/// The axis that a wall is across.
enum class Axis { x, y, z };
/// The side of a wall on which the material is, along the axis.
enum class Side { below, above };

/// The keys of [[solve.wall]]: a plane wall, present from one time to another.
struct WallOptions {
  Axis axis = Axis::x;
  double position = 0;             ///< map coordinate, or elevation [m]
  Side material_is = Side::above;  ///< where the material is
  WallKind kind = WallKind::roller;
  double friction_angle = 0;  ///< [deg]
  double speed = 0;           ///< along the axis [m/s]
  double to = 1e30;           ///< it stands until then [s]
  void describe(recipe::Visitor& v) {
    recipe::choice(v, "axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}, "normal of the wall");
    v.number("position_m", position, recipe::any, "map coordinate, or elevation");
    recipe::choice(v, "material_is", material_is, {{"above", Side::above}, {"below", Side::below}},
                   "where the material lies: at larger (above) or smaller (below) coordinates");
    recipe::choice(v, "kind", kind,
                   {{"roller", WallKind::roller}, {"fixed", WallKind::fixed}, {"frictional", WallKind::frictional}},
                   "roller: no motion along the axis; fixed: none at all; frictional: one-sided, with friction");
    v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "frictional: friction angle");
    v.number("speed_m_s", speed, recipe::any, "velocity of the wall along its axis");
    v.number("to_s", to, recipe::not_negative, "the wall goes at this time (a gate)");
  }
};

/// The keys of [[solve.obstacle]]: a body that the mass meets between the nodes.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path level_set;  ///< empty: OUT/obstacles.vdb
  std::string grid;            ///< in that file; empty: the obstacle's name, or the only one of a file that is given
  BodyInMemory body = {};      ///< instead of a file; no key
  double friction_angle = 20;  ///< [deg]
  void describe(recipe::Visitor& v) {
    v.text("name", name, "under which its force is recorded");
    v.path("level_set", level_set,
           "OpenVDB file of signed distances [m], negative inside; empty: obstacles.vdb in the output folder "
           "(talus-preprocess)");
    v.text(
        "grid", grid,
        "name of the level set in that file; empty: the obstacle's own, or the only one of a level_set that is given");
    v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "friction angle of its surface");
  }
};

}  // namespace talus::solver
