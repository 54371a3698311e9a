// The implicit solver in single precision.
#include "solver/implicit/implicit_solver.hpp"
#include "solver/integrator/scene.hpp"

namespace talus::solver {

template std::unique_ptr<Solver> make_implicit_solver_of<float>(const Scene&, const IntegratorSettings&,
                                                                const ImplicitControls&, const AnyDevice&,
                                                                const SolverState&);

}  // namespace talus::solver
