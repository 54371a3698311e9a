// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/loads.hpp"

#include <fmt/format.h>

namespace talus::solver {
namespace {

void need_three(recipe::Visitor& v, const char* key, const std::vector<double>& values) {
  v.needs(values.size() == 3,
          {fmt::format("[solve] {} has {} numbers", key, values.size()), "it is a vector: east, north, up",
           fmt::format("Give three: {} = [0.0, 0.0, 0.0]", key)});
}

}  // namespace

void GravityOptions::describe(recipe::Visitor& v) {
  v.numbers("gravity_m_s2", gravity, recipe::any, "gravity: east, north, up");
  need_three(v, "gravity_m_s2", gravity);
  v.numbers("initial_velocity_m_s", initial_velocity, recipe::any,
            "velocity of the whole mass at the start: east, north, up");
  need_three(v, "initial_velocity_m_s", initial_velocity);
}

void LoadOptions::describe(recipe::Visitor& v) {
  v.numbers("box_m", box, recipe::any,
            "west, east, south, north, bottom, top (the last two above the ground): points starting there");
  v.numbers("force_N", force, recipe::any, "force on them in all: east, north, up");
  v.needs(box.size() == 6 && force.size() == 3,
          {"[[solve.load]] box_m or force_N has the wrong number of values", "a box has six, a force three",
           "Give box_m = [west, east, south, north, bottom, top] and force_N = [east, north, up]"});
  v.number("ramp_s", ramp, recipe::not_negative, "time over which it grows to its full size");
}

}  // namespace talus::solver
