// The explicit solver in double precision.
#include "solver/integrator/explicit_solver_impl.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_explicit_solver_of<double>(const Scene&, const SolveOptions&, On,
                                                                 const SolverState&);

}  // namespace talus::solver
