#include "solver/options/walls.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace talus::solver {

void WallOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}, "normal of the wall");
  v.number("position_m", position, recipe::any, "map coordinate, or elevation");
  recipe::choice(v, "material_is", material_is, {{"above", Side::above}, {"below", Side::below}},
                 "where the material lies: at larger (above) or smaller (below) coordinates");
  recipe::choice(v, "kind", kind,
                 {{"roller", WallKind::roller}, {"fixed", WallKind::fixed}, {"frictional", WallKind::frictional}},
                 "roller: no motion along the axis; fixed: none at all; frictional: one-sided, with friction");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "frictional: friction angle");
  v.number("speed_m_s", speed, recipe::any, "velocity of the wall along its axis");
  v.number("from_s", from, recipe::not_negative, "the wall is there from this time");
  v.number("to_s", to, recipe::not_negative, "and goes at this time (a gate)");
}

void check_walls(const std::vector<WallOptions>& walls, std::vector<Fault>& faults) {
  if (walls.size() > most_walls) {
    faults.push_back({fmt::format("[[solve.wall]] is given {} times", walls.size()),
                      fmt::format("at most {} walls fit", most_walls), "Leave some out"});
  }
}

template <class Real>
Walls<Real> make_walls(const std::vector<WallOptions>& options, double time, const WallFrame& frame) {
  Walls<Real> walls;
  for (const WallOptions& o : options) {
    const double now = time * (1 + 1e-12);  // events a rounding apart are one
    if (now < o.from || now >= o.to) continue;
    Wall<Real>& wall = walls.list[walls.count++];
    wall.axis = static_cast<int>(o.axis);
    wall.side = o.material_is == Side::above ? 1 : -1;
    const double position = o.position + o.speed * (time - o.from);
    const int a = wall.axis;
    wall.position = static_cast<Real>((position - frame.origin[a]) / frame.cell[a]);
    wall.kind = o.kind;
    wall.friction = static_cast<Real>(std::tan(o.friction_angle * (std::numbers::pi / 180)));
    wall.speed = static_cast<Real>(o.speed);
  }
  return walls;
}

template Walls<float> make_walls(const std::vector<WallOptions>&, double, const WallFrame&);
template Walls<double> make_walls(const std::vector<WallOptions>&, double, const WallFrame&);

}  // namespace talus::solver
