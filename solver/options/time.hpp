// What a run simulates: how its steps are taken, from which domain, how long.
#pragma once

#include <filesystem>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

enum class Integrator { explicit_, newmark, quasi_static, automatic };
/// What the steps of an integrator can do; other keys state in these words what they need.
struct StepAbilities {
  bool count_losses = false;    // what is lost, by its cause
  bool repeat_bits = false;     // the same on every run on a GPU
  bool solve_systems = false;   // some of the steps at least
  bool average_volume = false;  // over the particles of an element, all of the steps
};
StepAbilities abilities_of(Integrator integrator);

enum class Preset { none, reference };

struct TimeOptions {
  Preset preset = Preset::none;
  Integrator integrator = Integrator::explicit_;
  double gravity_ramp = 0;           // [s]
  int gravity_loading_steps = 0;     // quasi-static steps before the start
  std::filesystem::path domain;      // empty: OUT/domain.vdb
  double end_time = 60;              // [s]
  double stop_kinetic_fraction = 0;  // of its peak; 0: never
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
