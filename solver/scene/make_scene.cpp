// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/make_scene.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/stage.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/scene/make_inflow.hpp"
#include "solver/scene/settings.hpp"
#include "solver/scene/tables.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace talus::solver {
namespace {

/// A lone point on the very ground would leave next to no mass on the node above it, and no explicit step would be
/// short enough. At a tenth of a layer sum N'^2/N is 11, which the default cfl of 0.5 still covers
/// (docs/explanation/theory.md, T11). Implicit steps can do with less, and statics with none; but a node with next to
/// no mass moves as it likes in a material without tension, and hands the point next to it a spin out of all measure.
constexpr double explicit_lowest_weighed = 0.1, newmark_lowest_weighed = 0.01;

/// Marks the points that start inside a load's box.
void attach_loads(const Domain& domain, const SolveOptions& options, Scene& scene, std::vector<Fault>& faults) {
  if (!options.loads.empty()) scene.points.load.assign(scene.points.size(), -1);
  for (std::size_t l = 0; l < options.loads.size(); ++l) {
    const auto& b = options.loads[l].extent;
    double volume = 0;
    for (std::size_t p = 0; p < domain.points.size(); ++p) {
      const double x = domain.points.x[p], y = domain.points.y[p], z = domain.points.height[p];
      if (x < b[0] || x > b[2] || y < b[1] || y > b[3] || z < b[4] || z > b[5]) continue;
      scene.points.load[p] = static_cast<int>(l);
      volume += domain.points.volume[p];
    }
    if (!(volume > 0))
      faults.push_back({fmt::format("[[solve.load]] number {}: no material point starts inside its box", l + 1),
                        "the load would pull at nothing",
                        "Widen extent_m (west, south, east, north, bottom, top above the ground)"});
    scene.load_volumes.push_back(volume);
  }
}

void attach_materials(const SolveOptions& options, Scene& scene, std::vector<Fault>& faults) {
  if (!options.parts.empty()) scene.points.material.assign(scene.points.size(), 0);
  for (std::size_t part = 0; part < options.parts.size(); ++part) {
    const std::string& name = options.parts[part].release;
    bool found = false;
    for (std::size_t p = 0; p < scene.points.size(); ++p) {
      if (scene.release_names[static_cast<std::size_t>(scene.points.release[p])] != name) continue;
      scene.points.material[p] = static_cast<int>(part) + 1;
      found = true;
    }
    for (const InflowSummary& inflow : scene.inflow.summaries) found = found || inflow.name == name;
    if (found) continue;
    faults.push_back({fmt::format("[[solve.part]] release = \"{}\": no material point is of that release", name),
                      fmt::format("the scene has {}", fmt::join(scene.release_names, ", ")),
                      "Name one of those, or leave the part out"});
  }
}

/// Refuses an inflow of the name of a release: results are told apart by name.
void check_release_names(const Scene& scene, std::vector<Fault>& faults) {
  const auto& names = scene.release_names;
  for (std::size_t n = names.size() - scene.inflow.summaries.size(); n < names.size(); ++n) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(n), names[n]) ==
        names.begin() + static_cast<std::ptrdiff_t>(n))
      continue;
    faults.push_back({fmt::format("[[solve.inflow]] name = \"{}\": a release has that name", names[n]),
                      "results are told apart by name", "Name the inflow otherwise"});
  }
}

/// A number of the bed that a raster gives.
struct PlacedNumber {
  double* value;                     ///< null where the law takes none of the raster
  std::function<double(double)> of;  ///< what the raster holds
};

PlacedNumber number_for(BaseOptions& base, std::string_view raster, double gravity) {
  if (base.uses(raster)) return {base.named(raster), [](double value) { return value; }};
  for (const BedForm& form : bed_forms) {
    if (raster == form.key && base.uses(form.of))
      return {base.named(form.of), [form, gravity](double value) { return number_of(form, value, gravity); }};
    if (raster == form.of && base.uses(form.key))
      return {base.named(form.key), [form, gravity](double value) { return form_of(form, value, gravity); }};
  }
  return {nullptr, {}};
}

/// The bed where domain.vdb has rasters of it: their values, the recipe's elsewhere.
std::vector<Bed<double>> make_bed(const Domain& domain, const SolveOptions& options) {
  std::vector<Bed<double>> bed;
  if (domain.bed.empty()) return bed;
  each_bed(domain, options, [&](const BaseFriction<double>& friction) { bed.push_back(friction.uniform); });
  return bed;
}

/// The depth of the water table at the start, normal to the bed, of every column [m]: of a raster of the domain, the
/// recipe's elsewhere.
std::vector<float> make_water_table(const Domain& domain, const SolveOptions& options, const TerrainTables& terrain) {
  if (!options.water.flows()) return {};
  std::vector<float> table(domain.grid.count());
  const auto given = std::ranges::find(domain.bed, water_table, [](const auto& named) { return named.first; });
  for (std::size_t n = 0; n < table.size(); ++n) {
    const double value = given == domain.bed.end() ? options.water.table_depth : given->second.values[n];
    const double depth = std::isfinite(value) ? value : options.water.table_depth;
    table[n] = static_cast<float>(depth / std::hypot(1.0, terrain.slope_x[n], terrain.slope_y[n]));
  }
  return table;
}

/// Refuses rasters that the law does not look at, which are a mistake in the recipe.
void check_bed(const Domain& domain, const SolveOptions& options, std::vector<Fault>& faults) {
  for (const auto& [name, raster] : domain.bed) {
    if (options.base.takes(name) || (name == water_table && options.water.flows())) continue;
    faults.push_back({fmt::format("[preprocess.bed] {} is given, but [solve.base] law does not use it", name),
                      "the raster would have no effect",
                      "Name the law that does, or leave the raster out and run talus-preprocess again"});
  }
}

/// Whether a point lies over known ground.
bool stands_on_ground(const Domain& domain, const TerrainTables& terrain, int i, int j) {
  return i >= 0 && j >= 0 && i < domain.grid.columns && j < domain.grid.rows && terrain.open[domain.grid.index(i, j)];
}

/// Throws DataError: a point lies over no known ground, or in no active cell of the grid that was made for it.
[[noreturn]] void refuse_place(const Domain& domain, const TerrainTables& terrain, std::size_t p) {
  const auto [i, j, layer] = nearest_cell(domain.grid, domain.layer_height, domain.points, p);
  if (!stands_on_ground(domain, terrain, i, j))
    throw DataError({fmt::format("domain.vdb: point {} at ({:.2f}, {:.2f}) stands outside the ground or at its edge", p,
                                 domain.points.x[p], domain.points.y[p]),
                     "a point needs known ground one cell around it",
                     "Give a larger elevation model, or a smaller source, and run talus-preprocess again"});
  throw DataError({fmt::format("domain.vdb: point {} at ({:.2f}, {:.2f}), {:.2f} m above the bed, lies in column {}, "
                               "row {}, layer {}, which is no active cell of the background grid",
                               p, domain.points.x[p], domain.points.y[p], domain.points.height[p], i, j, layer),
                   "points and mask \"active\" are not of one domain", "Run talus-preprocess again"});
}

/// The state of the domain's points as they are seeded, at the recipe's initial velocity.
ParticleState place_points(const Domain& domain, const SolveOptions& options, const GridShape& shape,
                           const TerrainTables& terrain, const ActiveCells& active) {
  ParticleState s;
  const std::size_t count = domain.points.size();
  s.resize(count);
  for (auto& list : s.extent) list.resize(count);
  for (auto& list : s.sides) list.resize(count);
  std::atomic<std::size_t> misplaced = count;  // the first one
  const auto place = [&](int n) {
    const auto p = static_cast<std::size_t>(n);
    const auto cell = nearest_cell(domain.grid, domain.layer_height, domain.points, p);
    if (!stands_on_ground(domain, terrain, cell[0], cell[1]) || !active.holds(cell)) {
      for (std::size_t first = misplaced; p < first && !misplaced.compare_exchange_weak(first, p);) continue;
      return;
    }
    const double xi = (domain.points.x[p] - domain.grid.west) / shape.spacing - 0.5;
    const double eta = (domain.points.y[p] - domain.grid.south) / shape.spacing - 0.5;
    place_in_cells(xi, s.cell[0][p], s.offset[0][p]);
    place_in_cells(eta, s.cell[1][p], s.offset[1][p]);
    double height = domain.points.height[p];
    if (shape.mapping == Mapping::cartesian) height += terrain_at(shape, terrain, xi, eta);
    place_in_cells(height / shape.layer_height, s.cell[2][p], s.offset[2][p]);
    for (int a = 0; a < 3; ++a) s.velocity[a][p] = options.initial_velocity[static_cast<std::size_t>(a)];
    s.volume[p] = domain.points.volume[p];
    const double wide = domain.points.extent_x[p], deep = domain.points.extent_y[p];
    s.extent[0][p] = wide / shape.spacing;
    s.extent[1][p] = deep / shape.spacing;
    s.extent[2][p] = s.volume[p] / (wide * deep * shape.layer_height);
    lay_sides(s, p, shape, terrain, wide, deep);
    s.id[p] = n;
    s.release[p] = domain.points.release[p];
  };
  for_each(CpuDevice::make(), static_cast<int>(count), place);
  if (misplaced < count) refuse_place(domain, terrain, misplaced);
  return s;
}

/// With "auto" the same for both integrators: a node of next to no mass contributes next to nothing to a change.
double lowest_weighed(const SolveOptions& options) {
  const StepAbilities steps = abilities_of(options.integrator);
  return steps.obey_cfl ? explicit_lowest_weighed : steps.carry_inertia ? newmark_lowest_weighed : 0;
}

}  // namespace

void lay_sides(ParticleState& points, std::size_t p, const GridShape& shape, const TerrainTables& terrain, double wide,
               double deep) {
  const std::size_t column = shape.index(points.cell[0][p], points.cell[1][p]);
  const double sides[6] = {wide, 0, terrain.slope_x[column] * wide, 0, deep, terrain.slope_y[column] * deep};
  for (int n = 0; n < 6; ++n) points.sides[n][p] = sides[n];
}

void each_bed(const Domain& domain, const SolveOptions& options,
              const std::function<void(const BaseFriction<double>&)>& visit) {
  SolveOptions here = options;
  std::vector<PlacedNumber> numbers;
  for (const auto& [name, raster] : domain.bed) numbers.push_back(number_for(here.base, name, options.gravity_size()));
  const BaseOptions everywhere = here.base;
  for (std::size_t column = 0; column < domain.grid.count(); ++column) {
    here.base = everywhere;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      const double value = domain.bed[n].second.values[column];
      if (numbers[n].value != nullptr && std::isfinite(value)) *numbers[n].value = numbers[n].of(value);
    }
    visit(make_base_friction<double>(here));
  }
}

std::string bed_sentence(const Domain& domain, const SolveOptions& options) {
  std::vector<std::string> names;
  for (const auto& [name, raster] : domain.bed) names.push_back(name);
  const std::string law = options.base.sentence();
  return names.empty() ? law : fmt::format("{} where no raster of {} says otherwise", law, fmt::join(names, " or "));
}

SolveOptions with_map_threshold(SolveOptions options, const Domain& domain) {
  if (!options.map_threshold) options.map_threshold = covering_thickness(domain.release_thickness.values);
  return options;
}

GridShape grid_shape(const Domain& domain, const SolveOptions& options) {
  GridShape shape;
  shape.columns = domain.grid.columns;
  shape.rows = domain.grid.rows;
  shape.spacing = domain.grid.cell;
  shape.layer_height = domain.layer_height;
  shape.mapping = options.mapping;
  shape.quadratic = options.shape == ShapeKind::quadratic;
  shape.lowest_weighed = lowest_weighed(options);
  shape.terrain = domain.terrain.values;
  return shape;
}

Scene begin_scene(const Domain& domain, const SolveOptions& options) {
  Scene scene;
  scene.map = domain.grid;
  scene.grid = grid_shape(domain, options);
  scene.terrain = make_terrain_tables(scene.grid);
  scene.inflow = make_inflow(domain, options, scene.grid, scene.terrain);
  scene.shaking = read_shaking(options.shaking);
  return scene;
}

Scene make_scene(const Domain& domain, const SolveOptions& options) {
  return finish_scene(domain, options, begin_scene(domain, options));
}

Scene finish_scene(const Domain& domain, const SolveOptions& options, Scene scene) {
  static_assert(ActiveCells::side == block_side, "domain.vdb and the solver's grid have blocks of the same columns");
  scene.grid.lowest_weighed = lowest_weighed(options);
  scene.active = domain.active ? *domain.active : active_cells(domain.grid, domain.layer_height, domain.points);
  scene.points = place_points(domain, options, scene.grid, scene.terrain, scene.active);
  scene.release_names = domain.release_names;
  for (const InflowSummary& inflow : scene.inflow.summaries) scene.release_names.push_back(inflow.name);
  std::vector<Fault> faults;
  if (scene.points.size() == 0 && options.inflows.empty())
    faults.push_back({"domain.vdb holds no material point, and the recipe no [[solve.inflow]]", "nothing would move",
                      "Give an inflow, or a release and leave no_release out of [preprocess]"});
  check_release_names(scene, faults);
  attach_loads(domain, options, scene, faults);
  attach_materials(options, scene, faults);
  check_bed(domain, options, faults);
  if (options.erosion.by_rate() && domain.erodible == 0)
    faults.push_back({"[solve.erosion] law = \"rate\", and the domain holds no ground that can be eroded",
                      "the law would have no effect", "Give [[preprocess.erodible]], or leave [solve.erosion] out"});
  if (!faults.empty()) throw RecipeError(std::move(faults));
  scene.bed = make_bed(domain, options);
  scene.water_table = make_water_table(domain, options, scene.terrain);
  if (options.erosion.by_rate()) scene.erodible = erodible_thickness(domain);
  scene.contacts = make_contact_points(domain.grid, scene.grid, scene.terrain, make_obstacles(options.obstacles));
  log_detail(fmt::format("scene: {} points placed", scene.points.size()));
  return scene;
}

std::vector<std::array<double, 3>> positions(const Scene& scene, const ParticleState& s) {
  const MapGrid& map = scene.map;
  const GridShape& shape = scene.grid;
  const TerrainTables& terrain = scene.terrain;
  std::vector<std::array<double, 3>> result(s.size());
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double xi = s.cell[0][p] + s.offset[0][p], eta = s.cell[1][p] + s.offset[1][p];
    double z = terrain.datum + (s.cell[2][p] + s.offset[2][p]) * shape.layer_height;
    if (shape.mapping == Mapping::terrain_following) z += terrain_at(shape, terrain, xi, eta);
    result[p] = {map.west + (xi + 0.5) * shape.spacing, map.south + (eta + 0.5) * shape.spacing, z};
  }
  return result;
}

FirstWaves first_waves(const SolveOptions& options) {
  return {fastest_wave(options), !abilities_of(options.flow_integrator()).solve_columns};
}

double explicit_step(const Scene& scene, const SolveOptions& options, double speed) {
  const double rate = first_rate(scene.grid, scene.terrain, scene.points, first_waves(options), speed);
  return std::min(options.step_over_cfl() / rate, options.largest_step);
}

double first_rate(const GridShape& shape, const TerrainTables& terrain, const ParticleState& points,
                  const FirstWaves& waves, double speed) {
  double steepest = 0;
  if (shape.mapping == Mapping::terrain_following) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      const std::size_t n = shape.index(points.cell[0][p], points.cell[1][p]);
      steepest = std::max(steepest, terrain.slope_x[n] * terrain.slope_x[n] + terrain.slope_y[n] * terrain.slope_y[n]);
    }
  }
  const double hx = 1 / shape.spacing, hz = 1 / shape.layer_height;
  const double across_layers = waves.bound_by_layers ? (1 + steepest) * hz * hz : 0;
  return waves.speed * std::sqrt(2 * hx * hx + across_layers) + speed * (2 * hx + hz * std::sqrt(1 + steepest));
}

}  // namespace talus::solver
