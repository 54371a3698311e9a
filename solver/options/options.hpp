// What a recipe's [solve] table says. Every key, its default and its help stand in describe() and nowhere else.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/implicit/controls.hpp"
#include "solver/material/material.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

enum class Precision { single_, double_ };
enum class ShapeKind { linear, quadratic, gimp };
enum class Transfer { apic, flip };
enum class StressUpdate { last, modified };  // USL, MUSL
enum class Integrator { explicit_, newmark, quasi_static, automatic };
enum class Preset { none, reference };
enum class Axis { x, y, z };
enum class Side { below, above };
enum class StiffnessKind { as_given, automatic };
enum class Cone { compression, extension, plane_strain };

struct MaterialOptions {
  MaterialModel model = MaterialModel::drucker_prager;
  double density = 2000;        // [kg/m3]
  double youngs_modulus = 1e7;  // [Pa]
  StiffnessKind stiffness = StiffnessKind::as_given;
  bool stiffness_check = false;        // run again, twice as stiff
  double poisson_ratio = 0.25;         // [-]
  double friction_angle = 30;          // [deg]
  double cohesion = 0;                 // [Pa]
  double dilatancy_angle = 0;          // [deg]
  double tension_cutoff = 0;           // [Pa]
  double pore_pressure_ratio = 0;      // water's part of the mean stress [-]
  double softening_slip = 0;           // over which strength falls to the residual one [m]; 0: it does not
  double residual_friction_angle = 0;  // [deg]
  double residual_cohesion = 0;        // [Pa]
  Cone cone = Cone::compression;
  bool softens() const { return model == MaterialModel::drucker_prager && softening_slip > 0; }
  void describe(recipe::Visitor& v);
};

struct BaseOptions {
  FrictionLaw law = FrictionLaw::coulomb;
  double friction_angle = 20;  // [deg]
  double peak_coefficient = 0.7;
  double steady_coefficient = 0.23;
  double characteristic_speed = 1;  // [m/s]
  double turbulence = 500;          // voellmy: xi [m/s2]
  double cohesion = 0;              // [Pa]
  double pore_pressure_ratio = 0;   // water's part of the normal stress [-]
  void describe(recipe::Visitor& v);
  /// The number that the recipe calls by this name, null where it has none that a raster can give.
  double* named(const std::string& key);
  bool uses(const std::string& key) const;  ///< whether the law looks at it
};

/// How an implicit step is taken.
struct ImplicitOptions {
  double step = 0.01;               // [s]
  double alpha = 0.25, beta = 0.5;  // Newmark
  int newton_iterations = 30;       // 1: the single linear solve of the reference paper
  double newton_tolerance = 1e-6;   // unbalanced force over the forces' size
  Tangent tangent = Tangent::frozen_yield;
  LinearSolver linear_solver = LinearSolver::pcg;
  double linear_tolerance = 1e-8;
  Forcing forcing = Forcing::eisenstat_walker;
  int linear_iterations = 5000;
  Operator form = Operator::points;
  Preconditioner preconditioner = Preconditioner::block;
  int step_cuts = 8;     // halvings before giving up
  double apex = 0.1;     // rounding of the cone's tip, in weights of a cell
  bool b_bar = false;    // element means of the volume change
  double filler = 1e-3;  // stiffness of springs that hold nearly empty nodes in statics, over that of a full cell
  void describe(recipe::Visitor& v);
};

/// A release of another material than [solve.material].
struct PartOptions {
  std::string release;
  MaterialOptions material;
  void describe(recipe::Visitor& v);
};

/// A plane wall, present from one time to another.
struct WallOptions {
  Axis axis = Axis::x;
  double position = 0;      // map coordinate, or elevation [m]
  Side side = Side::above;  // where the material is
  WallKind kind = WallKind::roller;
  double friction_angle = 0;   // [deg]
  double speed = 0;            // along the axis [m/s]
  double from = 0, to = 1e30;  // [s]
  void describe(recipe::Visitor& v);
};

/// A body that stands in the way.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path level_set;  // empty: OUT/obstacles.vdb
  std::string grid;                 // in that file; empty: the obstacle's name, or the only one of a file that is given
  double friction_angle = 20;       // [deg]
  double friction() const;          // coefficient
  void describe(recipe::Visitor& v);
};

/// A force on the points that start inside a box.
struct LoadOptions {
  std::vector<double> box = {0, 0, 0, 0, 0, 0};  // west, east, south, north [m], bottom, top above the ground [m]
  std::vector<double> force = {0, 0, 0};         // in all [N]
  double ramp = 0;                               // time over which it grows [s]
  double from = 0, to = 1e30;                    // [s]
  void describe(recipe::Visitor& v);
};

struct SolveOptions {
  Preset preset = Preset::none;
  Integrator integrator = Integrator::explicit_;
  ImplicitOptions implicit;
  std::vector<WallOptions> walls;
  std::vector<LoadOptions> loads;
  std::vector<ObstacleOptions> obstacles;
  double gravity_ramp = 0;           // [s]
  int gravity_loading_steps = 0;     // quasi-static steps before the start
  std::filesystem::path domain;      // empty: OUT/domain.vdb
  double end_time = 60;              // [s]
  double stop_kinetic_fraction = 0;  // of its peak; 0: never
  Precision precision = Precision::double_;
  Mapping mapping = Mapping::terrain_following;
  GroundContact ground = GroundContact::nodes;
  ShapeKind shape = ShapeKind::quadratic;
  Transfer transfer = Transfer::apic;
  double transfer_time = 10;  // CFL steps
  StressUpdate stress_update = StressUpdate::last;
  double damping = 0;  // Cundall's local factor
  double courant = 0.5;
  double largest_step = 1;                           // [s]
  std::vector<double> gravity = {0, 0, -9.81};       // [m/s2]
  std::vector<double> initial_velocity = {0, 0, 0};  // [m/s]
  double frame_interval = 10;                        // [s]
  double history_interval = 0.5;                     // [s]
  double checkpoint_interval = 0;                    // simulated [s]; 0: only when interrupted
  double map_threshold = 0.1;                        // [m]
  bool point_frames = true;
  bool vdb_frames = false;
  bool energy_budget = false;
  bool deterministic = false;
  MaterialOptions material;
  std::vector<PartOptions> parts;
  BaseOptions base;

  bool any_material(const std::function<bool(const MaterialOptions&)>& is) const;
  bool densities_differ() const {
    return any_material([&](const MaterialOptions& m) { return m.density != material.density; });
  }

  /// Whether the mass meets anything between nodes.
  bool meets_points() const { return !obstacles.empty() || ground == GroundContact::points; }

  void describe(recipe::Visitor& v);
  void check(std::vector<Fault>& faults) const;

 private:
  void check_contacts(std::vector<Fault>& faults) const;
};

/// Moduli, wave speed and cone from a recipe's words. Cone fitted to Mohr-Coulomb in triaxial compression or extension
/// (Chen & Mizuno 1990, table 4.1), or in plane strain for the flow its own dilatancy angle gives (the table's fit
/// where that is the friction angle).
template <class Real>
Material<Real> make_material(const MaterialOptions& options);

/// That of [solve.material] first, then those of the parts. Softening goes by slip: a band of shear is one cell wide,
/// so that the strain over which strength falls is the slip over the least side of a cell (Pietruszczak & Mroz 1981),
/// and results do not hang on the grid.
template <class Real>
Materials<Real> make_materials(const SolveOptions& options, double spacing, double layer_height);

/// The fastest wave of any of them [m/s].
double fastest_wave(const SolveOptions& options);

/// The bed's law with the same numbers everywhere.
template <class Real>
BaseFriction<Real> make_base_friction(const SolveOptions& options);

/// Map coordinates of node (0, 0, 0) and the spacing along each axis [m].
struct WallFrame {
  double origin[3], cell[3];
};

/// The options with `preset` spelt out: preset = "reference" sets what the reference paper states and leaves the rest
/// alone.
SolveOptions with_preset(SolveOptions options);

/// The walls that stand at a time.
template <class Real>
Walls<Real> make_walls(const std::vector<WallOptions>& options, double time, const WallFrame& frame);

}  // namespace talus::solver
