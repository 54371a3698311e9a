#include "solver/scene/make_solver.hpp"

#include <cmath>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/device.hpp"
#include "solver/scene/implicit_controls.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

template <class Real>
std::unique_ptr<Solver> make_explicit_solver_of(const Scene&, const SolveOptions&, On, const SolverState&);
template <class Real>
std::unique_ptr<Solver> make_implicit_solver_of(const Scene&, const SolveOptions&, const ImplicitControls&, On,
                                                const SolverState&);
// Instantiated in {ex,im}plicit_solver_{single,double}.cu.
extern template std::unique_ptr<Solver> make_explicit_solver_of<float>(const Scene&, const SolveOptions&, On,
                                                                       const SolverState&);
extern template std::unique_ptr<Solver> make_explicit_solver_of<double>(const Scene&, const SolveOptions&, On,
                                                                        const SolverState&);
extern template std::unique_ptr<Solver> make_implicit_solver_of<float>(const Scene&, const SolveOptions&,
                                                                       const ImplicitControls&, On, const SolverState&);
extern template std::unique_ptr<Solver> make_implicit_solver_of<double>(const Scene&, const SolveOptions&,
                                                                        const ImplicitControls&, On,
                                                                        const SolverState&);

SolverState first_state(const Scene& scene, const SolveOptions& options) {
  SolverState state;
  state.points = scene.points;
  const auto cells = scene.map.count();
  state.maps = {std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0),
                std::vector<double>(cells, -1.0)};
  state.clock.courant = options.cfl;
  state.clock.largest_step = options.largest_step;
  state.clock.transfer_time = options.transfer_time;
  state.clock.keeps_budget = options.energy_budget ? 1 : 0;
  const double speed =
      std::hypot(options.initial_velocity[0], options.initial_velocity[1], options.initial_velocity[2]);
  const GroundTables ground = make_ground_tables(scene.grid);
  const auto rate = static_cast<float>(first_rate(scene.grid, ground, scene.points, fastest_wave(options), speed));
  atomic_max_positive(&state.clock.rate_bits, rate);
  return state;
}

std::unique_ptr<Solver> make_solver(const Scene& scene, const SolveOptions& options, On on) {
  return resume_solver(scene, options, on, first_state(scene, options));
}

std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolveOptions& options, On on,
                                      const SolverState& state) {
  const bool single = options.precision == Precision::single_;
  if (options.integrator == Integrator::explicit_) {
    return single ? make_explicit_solver_of<float>(scene, options, on, state)
                  : make_explicit_solver_of<double>(scene, options, on, state);
  }
  const ImplicitControls controls = make_implicit_controls(options);
  return single ? make_implicit_solver_of<float>(scene, options, controls, on, state)
                : make_implicit_solver_of<double>(scene, options, controls, on, state);
}

On choose_device(On wanted) {
  if (wanted == On::gpu && !gpu_available()) {
    throw RecipeError({"--on gpu", "this machine has no GPU that the program can use", "Use --on cpu or --on auto"});
  }
  if (wanted == On::automatic) return gpu_available() ? On::gpu : On::cpu;
  return wanted;
}

}  // namespace talus::solver
