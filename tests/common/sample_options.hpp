// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Options with one key of every kind, as a stage would have them.
#pragma once

#include <string>

#include "common/recipe/recipe.hpp"

namespace talus::test {

enum class Shape { linear, quadratic, cubic };

struct Release {
  std::string name;
  double thickness = 0;
  std::filesystem::path polygons;
  void describe(recipe::Visitor& v) {
    v.text("name", name, "name of the release");
    v.number("thickness_m", thickness, recipe::not_negative, "vertical thickness");
    v.path("polygons", polygons, "vector file");
  }
  bool operator==(const Release&) const = default;
};

struct SampleMaterial {
  double friction = 25;
  double tension = recipe::infinity;
  void describe(recipe::Visitor& v, const double& density) {
    v.number("friction_angle_deg", friction, {0, 90, false, true}, "internal friction");
    v.number("tension_pa", tension, recipe::not_negative, "tension cut-off");
    v.needs(density < 1e5 || friction > 0,
            {"[solve.material] friction_angle_deg = 0 with so large a density", "nothing would hold it", "Raise it"});
  }
  bool operator==(const SampleMaterial&) const = default;
};

struct SampleOptions {
  double density = 2000;
  std::optional<double> seed_x;
  int steps = 10;
  bool verbose = false;
  std::string label = "plain \"quoted\" \\ text";
  std::filesystem::path terrain;
  std::vector<double> times{0, 2.5, 1e-7};
  std::vector<int> points_per_cell{2, 2, 2};
  Shape shape = Shape::quadratic;
  SampleMaterial material;
  std::vector<Release> releases;

  void describe(recipe::Visitor& v) {
    v.number("density_kg_m3", density, recipe::positive, "density of the moving mass");
    v.optional_number("seed_x_m", seed_x, recipe::any, "a point inside the source");
    recipe::table(v, "material", material, "what moves", density);
    v.integer("steps", steps, {1, 1000}, "how many");
    v.flag("verbose", verbose, "say more");
    v.needs(!verbose || steps > 1, {"[solve] verbose = true with steps = 1", "there is nothing to tell",
                                    "Take more steps, or leave verbose out"});
    v.text("label", label, "any text");
    v.path("terrain", terrain, "raster of the ground");
    v.numbers("times_s", times, recipe::not_negative, "when to write");
    v.integers("points_per_cell", points_per_cell, {1, 8}, "along x, y and z");
    recipe::choice(v, "shape", shape,
                   {{"linear", Shape::linear}, {"quadratic", Shape::quadratic}, {"cubic", Shape::cubic}},
                   "shape functions");
    v.needs(shape != Shape::cubic || steps > 1,
            {"[solve] shape = \"cubic\" with steps = 1", "it looks back two steps", "Take shape = \"quadratic\""});
    recipe::list(v, "release", releases, "what fails; several allowed", [&](Release& release, std::size_t number) {
      release.describe(v);
      v.needs(release.thickness < 1000,
              {"[[solve.release]] number " + std::to_string(number + 1), "no release is so thick", "Is it in metres?"});
    });
  }
  void check(std::vector<Fault>& faults) const {
    if (points_per_cell.size() != 3)
      faults.push_back({"[solve] points_per_cell", "three numbers are wanted", "Write [2, 2, 2]"});
  }
  bool operator==(const SampleOptions&) const = default;
};

}  // namespace talus::test
