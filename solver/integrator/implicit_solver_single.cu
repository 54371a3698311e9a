// The implicit solver in single precision.
#include "solver/integrator/implicit_solver_impl.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_implicit_solver_of<float>(const Scene&, const SolveOptions&, On,
                                                                const SolverState&);

}  // namespace talus::solver
