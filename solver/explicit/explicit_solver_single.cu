// The explicit solver in single precision.
#include "solver/explicit/explicit_solver.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_explicit_solver_of<float>(const Scene&, const SolveOptions&, On,
                                                                const SolverState&);

}  // namespace talus::solver
