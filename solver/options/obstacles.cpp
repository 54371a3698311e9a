// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/obstacles.hpp"

namespace talus::solver {

void ObstacleOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "under which its force is recorded");
  v.path("level_set", level_set,
         "OpenVDB file of signed distances [m], negative inside; empty: obstacles.vdb in the output folder "
         "(talus-preprocess)");
  v.text("grid", grid,
         "name of the level set in that file; empty: the obstacle's own, or the only one of a level_set that is given");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "friction angle of its surface");
}

}  // namespace talus::solver
