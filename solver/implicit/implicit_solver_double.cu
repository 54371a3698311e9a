// The implicit solver in double precision.
#include "solver/implicit/implicit_solver.hpp"
#include "solver/integrator/scene.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_implicit_solver_of<double>(const Scene&, const IntegratorSettings&,
                                                                 const ImplicitControls&, const AnyDevice&,
                                                                 const SolverState&);

}  // namespace talus::solver
