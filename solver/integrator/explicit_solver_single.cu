// The explicit solver in single precision.
#include "solver/integrator/explicit_solver_impl.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_explicit_solver_of<float>(const Scene&, const SolveOptions&, On,
                                                                const SolverState&);

}  // namespace talus::solver
