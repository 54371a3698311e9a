// The implicit solver in double precision.
#include "solver/integrator/implicit_solver_impl.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_implicit_solver_of<double>(const Scene&, const SolveOptions&, On,
                                                                 const SolverState&);

}  // namespace talus::solver
