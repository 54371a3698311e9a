#include "solver/run/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/device.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/run/thickness.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

const std::vector<std::string> history_names = {"time_s",
                                                "step",
                                                "step_size_s",
                                                "kinetic_J",
                                                "potential_J",
                                                "elastic_J",
                                                "volume_m3",
                                                "outflow_m3",
                                                "speed_max_m_s",
                                                "momentum_x_kg_m_s",
                                                "momentum_y_kg_m_s",
                                                "momentum_z_kg_m_s",
                                                "newton_iterations",
                                                "linear_iterations",
                                                "step_cuts",
                                                "step_over_cfl"};

const std::vector<std::string> budget_names = {"bed_loss_J",     "damping_loss_J", "plastic_loss_J", "transfer_loss_J",
                                               "reaction_x_N_s", "reaction_y_N_s", "reaction_z_N_s"};

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

Simulation::Simulation(const Domain& domain, const SolveOptions& options, On on, RunPaths paths,
                       std::string fingerprint)
    : domain_(domain),
      options_(with_preset(options)),
      on_(on),
      paths_(std::move(paths)),
      fingerprint_(std::move(fingerprint)),
      scene_(make_scene(domain, options_)),
      frames_(paths_.frames) {
  released_ = std::accumulate(scene_.points.volume.begin(), scene_.points.volume.end(), 0.0);
  if (options_.integrator == Integrator::automatic)
    choice_.emplace(std::min(scene_.grid.spacing, scene_.grid.layer_height), options_.largest_step);
}

/// For the integrator of the hour.
void Simulation::build_solver(const SolverState& state) {
  writing_.settle();  // a frame under way asks the solver for its ground
  SolveOptions o = options_;
  if (choice_) {
    o.integrator = choice_->current();
    o.implicit.step = choice_->implicit_step();
  }
  solver_ = resume_solver(scene_, o, on_, state);
}

/// A batch of steps, and with integrator = "auto" what follows from its cost.
BatchReport Simulation::advance() {
  if (!choice_) return solver_->advance();
  const auto begun = WallClock::now();
  const auto wall = [&] { return std::chrono::duration<double>(WallClock::now() - begun).count(); };
  const auto say = [&] {
    if (const std::string news = choice_->news(); !news.empty()) log_info(fmt::format("t {:.2f} s: {}", time_, news));
  };
  BatchReport batch;
  try {
    batch = solver_->advance();
  } catch (const NumericalError&) {
    if (choice_->current() == Integrator::explicit_) throw;
    choice_->note_failure(wall());
    say();
    build_solver(solver_->state());  // that of the last step that was accepted
    solver_->set_next_event(next_event());
    return advance();
  }
  cost_.simulated += batch.clock.time - time_;
  cost_.wall += wall();
  if (!batch.sorted || batch.clock.halt == failed) return batch;  // points that have left are still among the others
  const double rate = positive_from_bits(batch.clock.rate_bits);
  cost_.wave_step = rate > 0 ? 1 / rate : 0;
  cost_.speed = positive_from_bits(batch.clock.speed_bits);
  if (choice_->note(std::exchange(cost_, {}))) build_solver(solver_->state());
  say();
  return batch;
}

void Simulation::resume(const std::filesystem::path& file) {
  Checkpoint checkpoint = read_checkpoint(file, fingerprint_);
  build_solver(checkpoint.state);
  memory_ = std::move(checkpoint.memory);
  frames_.expect(memory_.frames);
  time_ = checkpoint.state.clock.time;
  wall_before_ = memory_.wall_time;
  log_info(fmt::format("going on from {} at t = {:.3f} s, step {}", file.string(), time_, checkpoint.state.clock.step));
}

void Simulation::start() {
  frames_.clear();
  std::error_code ignored;
  for (const auto& stale : {paths_.run, paths_.checkpoint}) std::filesystem::remove(stale, ignored);
  if (options_.gravity_loading_steps > 0) load_by_gravity();
  build_solver(first_state(scene_, make_settings(options_, scene_.grid).common));
  const auto add = [&](const std::string& name) { memory_.history.columns.push_back({name, "", "", "", {}}); };
  for (const std::string& name : history_names) add(name);
  if (options_.energy_budget) {
    for (const std::string& name : budget_names) add(name);
  }
  for (const ObstacleOptions& o : options_.obstacles) {
    for (const char* axis : {"x", "y", "z"}) add(fmt::format("obstacle_{}_impulse_{}_N_s", o.name, axis));
  }
  for (const std::string& note : scene_.contacts.notes) log_info(note);
  memory_.initial_thickness = solver_->thickness();
}

void Simulation::load_by_gravity() {
  Scene scene = scene_;
  for (auto& component : scene.points.velocity) std::fill(component.begin(), component.end(), 0.0);
  const auto loader =
      make_solver(scene, for_gravity_loading(make_settings(options_, scene.grid), options_.gravity_loading_steps), on_);
  loader->set_next_event(1);
  std::int64_t newton = 0, linear = 0;
  while (loader->clock().time < 1) {
    const BatchReport batch = loader->advance();
    newton += batch.stats.newton;
    linear += batch.stats.linear;
  }
  const ParticleState loaded = loader->state().points;
  ParticleState& start = scene_.points;
  for (std::size_t q = 0; q < loaded.size(); ++q) {
    const auto p = static_cast<std::size_t>(loaded.id[q]);
    double mean = 0;
    const int material = scene_.points.material[p];
    const MaterialOptions& own =
        material > 0 ? options_.parts[static_cast<std::size_t>(material) - 1].material : options_.material;
    if (own.model == MaterialModel::drucker_prager) {
      mean = (loaded.elastic[0][q] + loaded.elastic[1][q] + loaded.elastic[2][q]) / 3;
    }
    for (std::size_t a = 0; a < 6; ++a) start.elastic[a][p] = loaded.elastic[a][q] - (a < 3 ? mean : 0);
    start.log_volume[p] = loaded.log_volume[q];
  }
  log_info(fmt::format("gravity loading: {} steps, {} Newton and {} linear iterations", loader->clock().step, newton,
                       linear));
}

double Simulation::next_event() const {
  const double frame = static_cast<double>(memory_.frames) * options_.frame_interval;
  const double record = static_cast<double>(memory_.records) * options_.history_interval;
  double next = std::min({frame, record, options_.end_time});
  const auto consider = [&](double time) {
    if (time > time_ * (1 + 1e-12)) next = std::min(next, time);
  };
  for (const WallOptions& wall : options_.walls) {
    consider(wall.from);
    consider(wall.to);
  }
  for (const LoadOptions& load : options_.loads) {
    consider(load.from);
    consider(load.to);
  }
  return next;
}

void Simulation::pass_events(double time) {
  // Events a rounding apart are one: no step may be asked to go from one to the other.
  const double reached = time * (1 + 1e-12);
  if (reached >= static_cast<double>(memory_.records) * options_.history_interval || time >= options_.end_time) {
    record(time);
    ++memory_.records;
  }
  if (reached >= static_cast<double>(memory_.frames) * options_.frame_interval) {
    put_frame(time);
    ++memory_.frames;
  }
}

void Simulation::record(double time) {
  const Energies e = solver_->energies();
  const Clock clock = solver_->clock();
  kinetic_ = e.kinetic;
  memory_.peak_kinetic = std::max(memory_.peak_kinetic, e.kinetic);
  std::vector<double> row{time,
                          static_cast<double>(clock.step),
                          clock.step_size,
                          e.kinetic,
                          e.potential,
                          e.elastic,
                          e.volume,
                          memory_.outflow_volume,
                          static_cast<double>(positive_from_bits(clock.speed_bits)),
                          e.momentum.x,
                          e.momentum.y,
                          e.momentum.z,
                          static_cast<double>(memory_.newton),
                          static_cast<double>(memory_.linear),
                          static_cast<double>(memory_.cuts),
                          over_cfl_};
  if (options_.energy_budget) {
    row.insert(row.end(), {clock.bed_loss, clock.damping_loss, clock.plastic_loss, clock.transfer_loss,
                           clock.reaction[0], clock.reaction[1], clock.reaction[2]});
  }
  for (const Vec3<double>& impulse : solver_->obstacle_impulses())
    row.insert(row.end(), {impulse.x, impulse.y, impulse.z});
  for (std::size_t c = 0; c < memory_.history.columns.size(); ++c) memory_.history.columns[c].values.push_back(row[c]);
}

PointFrame Simulation::point_frame(double time, const ParticleState& s) const {
  const auto materials = make_materials<double>(options_, scene_.grid.spacing, scene_.grid.layer_height);
  PointFrame frame;
  frame.time = time;
  frame.position = positions(scene_.map, scene_.grid, solver_->ground(), s);
  for (std::size_t p = 0; p < s.size(); ++p) {
    frame.velocity.push_back({static_cast<float>(s.velocity[0][p]), static_cast<float>(s.velocity[1][p]),
                              static_cast<float>(s.velocity[2][p])});
    frame.volume.push_back(static_cast<float>(s.volume[p]));
    const MaterialState<double> state{
        {s.elastic[0][p], s.elastic[1][p], s.elastic[2][p], s.elastic[3][p], s.elastic[4][p], s.elastic[5][p]},
        s.log_volume[p],
        s.plastic_log_volume[p]};
    frame.pressure.push_back(static_cast<float>(
        -trace(kirchhoff_stress(materials.of(s.material.data(), s.plastic_shear.data(), static_cast<int>(p)), state)) /
        3));
  }
  frame.id = s.id;
  frame.release = s.release;
  return frame;
}

/// The state is taken at once; the file is written while the run goes on.
void Simulation::put_frame(double time) {
  const bool points = options_.point_frames || options_.vdb_frames;
  writing_.start([this, time, number = memory_.frames, thickness = solver_->thickness(),
                  state = points ? solver_->shown() : ParticleState{}] {
    PointFrame frame = point_frame(time, state);
    if (options_.vdb_frames)
      write_points_vdb(paths_.vdb_frames / fmt::format("points_{:05}.vdb", number), frame, scene_.map.cell);
    if (!options_.point_frames) {
      frame = {};
      frame.time = time;
    }
    frames_.put(number, frame, scene_.map, thickness);
  });
}

bool Simulation::checkpoint_due(double time) const {
  if (options_.checkpoint_interval <= 0) return false;
  return time >= static_cast<double>(memory_.checkpoints + 1) * options_.checkpoint_interval;
}

void Simulation::save_checkpoint() {
  memory_.wall_time = wall_time();
  writing_.settle();  // a checkpoint counts on its frames, and HDF5 does one thing at a time
  write_checkpoint(paths_.checkpoint, {fingerprint_, solver_->state(), memory_});
}

bool Simulation::calm() const {
  return options_.stop_kinetic_fraction > 0 && kinetic_ < options_.stop_kinetic_fraction * memory_.peak_kinetic;
}

double Simulation::wall_time() const {
  return wall_before_ + std::chrono::duration<double>(WallClock::now() - started_).count();
}

void Simulation::report(Progress& progress, const Clock& clock) const {
  if (!progress.due()) return;
  const double done = clock.time / options_.end_time;
  const HistoryColumn *volume = memory_.history.find("volume_m3"), *outflow = memory_.history.find("outflow_m3");
  const bool recorded = volume && outflow && !volume->values.empty();
  const double balance = recorded ? (volume->values.back() + outflow->values.back()) / released_ - 1 : 0;
  progress.update(fmt::format("t {:.2f}/{:g} s  step {}  dt {:.3g} s  v_max {:.1f} m/s  mass error {:.1e}  eta {}",
                              clock.time, options_.end_time, clock.step, clock.step_size,
                              positive_from_bits(clock.speed_bits), balance,
                              done > 0 ? duration(wall_time() * (1 - done) / done) : "?"));
}

void Simulation::fail(const Clock& clock) const {
  const ParticleState s = solver_->state().points;
  std::string where = "unknown place";
  const auto found = std::find(s.id.begin(), s.id.end(), clock.failed_point);
  if (found != s.id.end()) {
    const auto p = static_cast<std::size_t>(found - s.id.begin());
    where = fmt::format("({:.1f}, {:.1f})", scene_.map.x(s.cell[0][p]), scene_.map.y(s.cell[1][p]));
  }
  throw NumericalError(
      {fmt::format("step {}, t = {:.4f} s: material point {} near {} lost its state (not a number, or faster "
                   "than 1000 km/s)",
                   clock.step, clock.time, clock.failed_point, where),
       fmt::format("the step of {:.3g} s is too long for it", clock.step_size),
       fmt::format("Lower cfl (now {:g}), or use shape = \"quadratic\" with transfer = \"apic\"", options_.cfl)});
}

RunSummary Simulation::run(const std::string& scene, const std::string& title) {
  started_ = WallClock::now();
  RunSummary summary;
  summary.scene = scene;
  summary.title = title;
  const bool fresh = solver_ == nullptr;
  if (fresh) start();
  started_ = WallClock::now();
  if (fresh) pass_events(0.0);
  Progress progress;
  summary.stop_reason = "end of the simulated time";
  while (time_ < options_.end_time) {
    solver_->set_next_event(next_event());
    const BatchReport batch = advance();
    time_ = batch.clock.time;
    memory_.outflow_volume += batch.outflow_volume;
    memory_.outflow_count += batch.outflow_count;
    if (batch.clock.halt == failed) fail(batch.clock);
    count(batch);
    if (batch.sorted && (interrupted() || checkpoint_due(time_))) {
      if (checkpoint_due(time_)) ++memory_.checkpoints;
      save_checkpoint();
    }
    if (batch.sorted && interrupted()) {
      throw Interrupted({fmt::format("stopped at t = {:.3f} s, step {}", time_, batch.clock.step), "interrupted",
                         fmt::format("Go on with --restart; {} holds the state", paths_.checkpoint.string())});
    }
    if (batch.clock.halt == at_event) pass_events(time_);
    report(progress, batch.clock);
    if (calm()) {
      summary.stop_reason = fmt::format("kinetic energy below {:g} of its peak", options_.stop_kinetic_fraction);
      break;
    }
    if (solver_->particle_count() == 0) {
      summary.stop_reason = "all material left the domain";
      break;
    }
  }
  if (time_ > static_cast<double>(memory_.frames - 1) * options_.frame_interval) {
    put_frame(time_);  // the end, between two frames
    ++memory_.frames;
  }
  finish(summary);
  return summary;
}

void Simulation::count(const BatchReport& batch) {
  if (batch.stats.newton == 0) {
    const double rate = positive_from_bits(batch.clock.rate_bits);
    if (rate > 0) over_cfl_ = batch.clock.step_size * rate;
    return;
  }
  memory_.newton += batch.stats.newton;
  memory_.linear += batch.stats.linear;
  memory_.cuts += batch.stats.cuts;
  over_cfl_ = batch.stats.over_cfl;
  log_detail(fmt::format(
      "step {}  t {:.6g} s  dt {:.3g} s ({:.3g} CFL)  newton {}  cg {}  unbalanced {:.1e}  cuts {}{}", batch.clock.step,
      batch.clock.time, batch.clock.step_size, over_cfl_, batch.stats.newton, batch.stats.linear, batch.stats.residual,
      batch.stats.cuts, batch.stats.indefinite ? "  indefinite tangent, convex part taken" : ""));
}

RunMaps Simulation::final_maps() const {
  const MapFields fields = solver_->state().maps;
  RunMaps maps;
  maps.grid = scene_.map;
  maps.terrain = domain_.terrain.values;
  maps.before = domain_.before.values;
  maps.initial_thickness = memory_.initial_thickness;
  maps.deposit_thickness = solver_->thickness();
  maps.peak_thickness = fields.peak_thickness;
  if (domain_.release_names.size() > 1) tell_apart(maps);
  maps.peak_speed = fields.peak_speed;
  maps.peak_pressure = fields.peak_pressure;
  for (double& value : maps.peak_pressure) value /= 1000;  // Pa to kPa
  maps.arrival_time = fields.arrival;
  for (double& value : maps.arrival_time) {
    if (value < 0) value = std::numeric_limits<double>::quiet_NaN();
  }
  maps.threshold = options_.map_threshold;
  return maps;
}

bool Simulation::went_along(const ParticleState& s, std::size_t p) const {
  if (s.release[p] >= domain_.erodible) return true;
  const auto first = static_cast<std::size_t>(s.id[p]);
  const auto moved = [&](int a) {
    return s.cell[a][p] + s.offset[a][p] - scene_.points.cell[a][first] - scene_.points.offset[a][first];
  };
  return std::hypot(moved(0), moved(1)) > 1;
}

void Simulation::tell_apart(RunMaps& maps) const {
  const ParticleState end = solver_->state().points;
  const ParticleState& start = scene_.points;
  const auto map_of = [&](const ParticleState& s, const std::function<bool(std::size_t)>& counts) {
    return thickness_of(scene_, options_, s, counts);
  };
  for (std::size_t r = 0; r < domain_.release_names.size(); ++r) {
    maps.deposit_of.emplace_back(domain_.release_names[r], map_of(end, [&](std::size_t p) {
                                   return end.release[p] == static_cast<int>(r) && went_along(end, p);
                                 }));
  }
  if (domain_.erodible == 0) return;
  maps.initial_thickness = map_of(start, [&](std::size_t p) { return start.release[p] >= domain_.erodible; });
  maps.deposit_thickness = map_of(end, [&](std::size_t p) { return went_along(end, p); });
  const auto layer = map_of(start, [&](std::size_t p) { return start.release[p] < domain_.erodible; });
  const auto left = map_of(end, [&](std::size_t p) { return !went_along(end, p); });
  for (std::size_t c = 0; c < layer.size(); ++c) {
    maps.eroded_depth.push_back(std::max(0.0, layer[c] - left[c]));
    maps.peak_thickness[c] = std::max(0.0, maps.peak_thickness[c] - layer[c]);
  }
}

void Simulation::report_obstacles() const {
  const RunHistory& history = memory_.history;
  const std::vector<double>& time = history.columns[0].values;
  const std::size_t count = options_.obstacles.size();
  for (std::size_t o = 0; o < count; ++o) {
    const auto impulse = [&](std::size_t axis, std::size_t row) {
      return history.columns[history.columns.size() - 3 * (count - o) + axis].values[row];
    };
    double peak = 0, when = 0;
    for (std::size_t row = 1; row < time.size(); ++row) {
      const double span = time[row] - time[row - 1];
      const auto change = [&](std::size_t axis) { return (impulse(axis, row) - impulse(axis, row - 1)) / span; };
      const double force = span > 0 ? std::hypot(change(0), change(1), change(2)) : 0;
      if (force > peak) when = time[row];
      peak = std::max(peak, force);
    }
    const std::size_t last = time.size() - 1;
    log_info(fmt::format(
        "obstacle {}: impulse ({:.4g}, {:.4g}, {:.4g}) N s, largest mean force over {:g} s {:.4g} N until t = {:.2f} s",
        options_.obstacles[o].name, impulse(0, last), impulse(1, last), impulse(2, last), options_.history_interval,
        peak, when));
  }
}

void Simulation::finish(RunSummary& summary) {
  const SolverState state = solver_->state();
  memory_.wall_time = wall_time();
  summary.on = on_ == On::gpu ? gpu_name() : hardware();
  summary.precision = options_.precision == Precision::double_ ? "double" : "single";
  summary.version = version();
  summary.particles = static_cast<std::int64_t>(scene_.points.size());
  summary.particles_outflow = memory_.outflow_count;
  summary.steps = state.clock.step;
  summary.time_end = time_;
  summary.wall_time = memory_.wall_time;
  summary.memory = static_cast<double>(solver_->bytes());
  for (const auto& [owner, bytes] : solver_->memory())
    summary.memory_of.emplace_back(owner, static_cast<double>(bytes));
  for (const Profile::Phase& p : profile_of(on_).phases()) summary.profile.emplace_back(p.name, p.seconds);
  summary.density = options_.material.density;
  summary.volume_released = released_;
  summary.volume_final = std::accumulate(state.points.volume.begin(), state.points.volume.end(), 0.0);
  summary.volume_outflow = memory_.outflow_volume;
  if (domain_.erodible > 0) {
    summary.volume_released = summary.volume_final = 0;
    for (std::size_t p = 0; p < scene_.points.size(); ++p) {
      if (scene_.points.release[p] >= domain_.erodible) summary.volume_released += scene_.points.volume[p];
    }
    for (std::size_t p = 0; p < state.points.size(); ++p) {
      if (went_along(state.points, p)) summary.volume_final += state.points.volume[p];
    }
    summary.volume_entrained = summary.volume_final + summary.volume_outflow - summary.volume_released;
  }
  summary.provenance = domain_.provenance;
  writing_.settle();
  RunWriter writer(paths_.run);
  frames_.append_to(writer, memory_.frames, scene_.map);
  writer.finish(final_maps(), memory_.history, summary);
  report_obstacles();
  log_detail(fmt::format("files: {:.1f} s after the last step", wall_time() - memory_.wall_time));
  frames_.clear();
  std::error_code ignored;
  std::filesystem::remove(paths_.checkpoint, ignored);  // the run is whole: nothing is left to go on with
}

}  // namespace talus::solver
