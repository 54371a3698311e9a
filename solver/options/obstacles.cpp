#include "solver/options/obstacles.hpp"

#include <fmt/format.h>

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

void need_names(recipe::Visitor& v, const std::vector<ObstacleOptions>& obstacles) {
  const char* why = "its forces are recorded under its name";
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    const std::string& name = obstacles[o].name;
    const bool plain =
        !name.empty() &&
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
    v.needs(plain, {fmt::format("[[solve.obstacle]] number {}: name = \"{}\"", o + 1, name), why,
                    "Give it one of letters, digits, - and _"});
    for (std::size_t earlier = 0; earlier < o; ++earlier) {
      v.needs(!plain || obstacles[earlier].name != name,
              {fmt::format("[[solve.obstacle]] name = \"{}\" is given twice", name), why, "Rename one"});
    }
  }
}

}  // namespace talus::solver
