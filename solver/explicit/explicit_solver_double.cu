// The explicit solver in double precision.
#include "solver/explicit/explicit_solver.hpp"
#include "solver/integrator/scene.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_explicit_solver_of<double>(const Scene&, const IntegratorSettings&,
                                                                 const AnyDevice&, const SolverState&);

}  // namespace talus::solver
