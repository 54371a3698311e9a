// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Factor of safety by strength reduction (T40), and the mass that fails first.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "common/domain/domain.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// Two factors with the limit between them.
struct FactorBracket {
  double low = 0;                                         ///< the largest that held; 0: none did
  double high = std::numeric_limits<double>::infinity();  ///< the smallest that did not; infinity: all held
  /// Whether both ends were found.
  bool closed() const { return low > 0 && high < std::numeric_limits<double>::infinity(); }
  double middle() const { return 0.5 * (low + high); }  ///< middle of a closed bracket
};

/// How long and how far the search goes.
struct FactorBounds {
  double tolerance = 0.005;           ///< width of the bracket over its lower end [-]
  double least = 0.01, largest = 20;  ///< factors beyond which the search ends [-]
};

/// The function brackets the factor up to which `holds` is true, which must not become true again beyond it. It begins
/// at 1 and goes up or down by a quarter until the answer changes; above a lower end that is `known` it goes up by 2 %
/// first, and by more each time. It halves the bracket from there on.
FactorBracket bracket_factor(const std::function<bool(double)>& holds, const FactorBounds& bounds,
                             FactorBracket known = {});

/// A factor that was tried: whether the ground so weakened finds an equilibrium under its weight.
struct StabilityTrial {
  double factor = 0;
  bool holds = false;
  std::int64_t newton = 0, linear = 0;  ///< iterations; 0 where none was found
  double way = 0;                       ///< of the farthest point from where it was without weight [m]; 0: none found.
                                        ///< Where it does not hold: too far for the same shape (T40c)
  bool by_motion = false;               ///< Newton's iterations found none, but the ground let go stays
};

/// The ground as it fails (T40b): weakened by a little more than the factor, let go from the last equilibrium.
struct Failure {
  double factor = 0;                ///< by which its strength is divided
  double time = 0;                  ///< since it was let go [s]
  bool moves = false;               ///< its kinetic energy grows as that of a mass that falls
  double way = 0;                   ///< of the mass that fails: mean over its points, weighed by their own ways [m]
  std::vector<double> shares = {};  ///< of every point of the domain, by id: its way over that [-]; empty: not computed
};

struct Stability {
  FactorBracket factor;
  std::vector<StabilityTrial> trials;  ///< in their order
  double stiffening = 1;               ///< factor of the moduli that it was computed with (T40a)
  Failure failure;                     ///< only with a closed bracket
};

/// The search for the factor of safety of a scene.
class StabilitySearch {
 public:
  /// Keeps references to `domain` and makes the scene. Throws RecipeError and DataError as make_scene() does.
  StabilitySearch(const Domain& domain, const SolveOptions& options, const AnyDevice& device);

  /// The method brackets the factor and lets the mass fail. It throws Interrupted.
  Stability run();

  const Scene& scene() const { return scene_; }  ///< scene that it looks at, without weight
  /// The options that the ground is computed with: stiffer than the recipe's where that is soft.
  const SolveOptions& options() const { return options_; }

 private:
  Scene weakened_scene(double factor) const;
  std::optional<SolverState> rest(double factor, const SolverState* from, StabilityTrial& trial) const;
  StabilityTrial attempt(double factor);
  bool keep(std::optional<SolverState> state, StabilityTrial& trial);
  void look_again(StabilityTrial& trial);
  Failure fail(double factor);
  double way_of(const SolverState& state, double share) const;

  const Domain& domain_;
  double stiffening_;
  SolveOptions options_;
  AnyDevice device_;
  Scene scene_;
  std::vector<std::array<double, 3>> seeds_;  ///< positions of the points, by id [m]
  SolverState held_;                          ///< the equilibrium of the largest factor that held
  double held_factor_ = 0;
  double most_way_ = std::numeric_limits<double>::infinity();  ///< in an equilibrium of this shape [m]
  Failure nearest_;       ///< of the least factor at which a second look found no equilibrium
  bool trusting_ = true;  ///< Newton's iterations have not yet missed an equilibrium that is there
};

}  // namespace talus::solver
