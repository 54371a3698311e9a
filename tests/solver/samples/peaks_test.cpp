// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slides on data_samples/hard_terrains.hpp: bounds of their energy, packing and maps, and their footprint.
#include "common/map/statistics.hpp"
#include "tests/solver/samples/sample_scene.hpp"

namespace talus::solver::testing {
namespace {

constexpr double g = 9.81;

struct LaidScene {
  const char* name;
  SampleScene (*scene)();
  double end;  ///< [s]
};

/// A ledge 310 m over a plain, upright but for a cell, and a slab that slides off it: columns of little mass in flight.
Domain upright_cliff() {
  Domain d = ground(56, 16, 10, 5, [](double x, double) { return x < 200 ? 310 + 0.6 * (200 - x) : 0.0; });
  fill(d, {60, 160, 40, 120, 0, 12});
  release(d, {6, 16}, {4, 12}, 12);
  return d;
}

class SamplePeaks : public InEachPlace {
 protected:
  /// What may be compared of a run at its end.
  struct Peaks {
    double fastest;   ///< of any point at any time [m/s]
    double speed;     ///< largest of the map [m/s]
    double pressure;  ///< largest of the map [Pa]
  };

  static Peaks peaks_of(const Scene& scene, const SolveOptions& o, double end) {
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, end);
    const SolverState state = solver->state();
    // The worst sample has 3.2 over time, and a quarter is to spare (docs/notes/grid-and-transfer.md).
    const Packing packing = solver->packing();
    EXPECT_LT(packing.p99, 4);
    EXPECT_GE(packing.largest, packing.p99);
    expect_below_fall(scene, state.maps.peak_speed);
    const auto largest = [](const std::vector<double>& map) { return *std::max_element(map.begin(), map.end()); };
    return {static_cast<double>(positive_from_bits(state.clock.control.fastest_bits)), largest(state.maps.peak_speed),
            largest(state.maps.peak_pressure)};
  }

  /// Each cell against the fall from the highest point at the start to the ground in it. Less than 20 m below that, a
  /// column's share of points beside it counts for more than its own ground.
  static void expect_below_fall(const Scene& scene, const std::vector<double>& speed) {
    double top = -1e300;
    for (const auto& place : positions(scene, scene.points)) top = std::max(top, place[2]);
    for (std::size_t c = 0; c < speed.size(); ++c) {
      const double drop = top - scene.grid.terrain[c];
      if (!(drop > 20)) continue;
      EXPECT_LE(speed[c], std::sqrt(2 * g * drop)) << "cell " << c;
    }
  }

  static void expect_within(const Peaks& peaks, double density) {
    // The fastest point is kept in single precision: 6e-8.
    const double bound = peaks.fastest * (1 + 1e-6);
    EXPECT_LE(peaks.speed, bound);
    EXPECT_LE(peaks.pressure, density * bound * bound);
    EXPECT_GT(peaks.speed, 0.7 * peaks.fastest) << "the map saw the flow";
  }
};
TALUS_IN_EACH_PLACE(SamplePeaks);

TEST_P(SamplePeaks, no_cell_of_the_samples_is_faster_than_the_fastest_point_or_its_fall) {
  for (const LaidScene& c :
       {LaidScene{"rough slope", rough_slope_scene, 4}, LaidScene{"bent gully", bent_gully_scene, 5},
        LaidScene{"cliff and bench", cliff_bench_scene, 8}, LaidScene{"thinning slide", thinning_slide_scene, 10}}) {
    for (const Mapping mapping : {Mapping::terrain_following, Mapping::cartesian}) {
      SCOPED_TRACE(c.name);
      SampleScene sample = c.scene();
      sample.options.mapping = mapping;
      const Scene scene = make_scene(domain_of(sample), sample.options);
      expect_within(peaks_of(scene, sample.options, c.end), 2000);
    }
  }
}

/// Momentum over mass of the columns' nodes had made 193 m/s of points that ran at 83 m/s.
TEST_P(SamplePeaks, no_cell_below_an_upright_cliff_is_faster_than_the_fastest_point_or_its_fall) {
  const Domain domain = upright_cliff();
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    SolveOptions o = stepping_by(integrator);
    o.mapping = Mapping::cartesian;
    o.material.friction_angle = 35;
    o.base.friction_angle = 15;
    o.implicit.step = 0.1;
    o.implicit.newton_tolerance = 1e-3;
    const Scene scene = make_scene(domain, o);
    // Newton's steps of 0.1 s on what falls apart are slow: until half of it is over the edge.
    const double end = integrator == Integrator::explicit_ ? 16 : 8;
    expect_within(peaks_of(scene, o, end), o.material.density);
  }
}

struct BoundedScene {
  const char* name;
  SampleScene (*scene)();
  double interval, end;  ///< [s]
};
constexpr BoundedScene bounded_scenes[] = {{"rough slope", rough_slope_scene, 2, 14},
                                           {"bent gully", bent_gully_scene, 2, 16},
                                           {"cliff and bench", cliff_bench_scene, 1, 12},
                                           {"thinning slide", thinning_slide_scene, 2, 30}};

class SampleBounds : public InEachPlace {
 protected:
  /// Kinetic energy over that of a fall without any loss, and over what friction leaves of it; the largest of a run.
  struct Shares {
    double most = 0;    ///< of the fastest point, without friction
    double high = 0;    ///< at the 99.9th percentile, friction on the way beyond the release taken off
    double centre = 0;  ///< of all of the mass, friction on the way of its centre taken off
  };

  /// The largest packing of a run so far, at the instants that are looked at.
  static void look_at_packing(const SampleRun& run, Packing& worst) {
    const Packing now = run.packing();
    worst.p99 = std::max(worst.p99, now.p99);
    worst.largest = std::max(worst.largest, now.largest);
  }

  /// Points that gather within cells, as nothing of the grid forbids, are denser than points that lie by chance.
  static void expect_no_denser_than_chance(const SampleRun& run, const BoundedScene& bounded, const Packing& worst) {
    const SampleScene& sample = run.sample();
    const double cells = run.released() / (sample.cell * sample.cell * sample.layer_height);
    const PointsByChance chance{cells, static_cast<double>(run.scene().points.size()), bounded.end / bounded.interval};
    const std::vector<double> thickness = run.peak_thickness();
    const double squashed = squash(*std::max_element(thickness.begin(), thickness.end()), sample.options.material);
    const double p99 = squashed * chance.packing(0.01), largest = squashed * chance.packing(0);
    EXPECT_LT(worst.p99, p99);
    EXPECT_LT(worst.largest, largest);
    EXPECT_GE(worst.p99, 1) << "99 % of what lies in heaps is not looser than at the start";
  }

  static double friction_of(const SampleScene& scene) {
    return std::tan(scene.options.base.friction_angle * M_PI / 180);
  }

  /// The method looks at a run at an instant.
  static void look(const SampleRun& run, const std::vector<PointSeen>& start, Shares& worst) {
    const std::vector<PointSeen> points = run.points();
    const double mu = friction_of(run.sample()), front = reach_of(start, 1);
    const double top = std::max_element(start.begin(), start.end(), lower)->z;
    std::vector<double> shares;
    for (const PointSeen& p : points) {
      const double fallen = g * (top - p.z), rubbed = g * mu * std::max(0.0, p.x - front);
      worst.most = std::max(worst.most, 0.5 * p.speed * p.speed / fallen);
      shares.push_back(0.5 * p.speed * p.speed / (fallen - rubbed));
      ASSERT_TRUE(std::isfinite(p.x + p.y + p.z + p.speed));
      ASSERT_GE(p.height, -0.1 * run.sample().layer_height);
    }
    worst.high = std::max(worst.high, quantile(shares, 0.999));
    const Mean now = mean_of(points), was = mean_of(start);
    worst.centre = std::max(worst.centre, now.half_square / (g * (was.z - now.z - mu * (now.x - was.x))));
    EXPECT_NEAR(now.volume + run.left(), run.released(), 1e-12 * run.released());
  }

 private:
  static bool lower(const PointSeen& a, const PointSeen& b) { return a.z < b.z; }
};
TALUS_IN_EACH_PLACE(SampleBounds);

TEST_P(SampleBounds, no_slide_has_more_energy_than_it_fell_through) {
  for (const BoundedScene& bounded : bounded_scenes) {
    SCOPED_TRACE(bounded.name);
    SampleRun run(bounded.scene(), GetParam());
    const std::vector<PointSeen> start = run.points();
    Shares worst;
    Packing packing;
    for (int n = 1; n * bounded.interval <= bounded.end; ++n) {
      run.run_to(n * bounded.interval);
      look(run, start, worst);
      look_at_packing(run, packing);
    }
    EXPECT_LT(worst.most, 1);
    EXPECT_LT(worst.high, 1);
    EXPECT_LT(worst.centre, 1.02);  // what flies owes the friction of its way until it lands
    EXPECT_LT(run.left(), 1e-4 * run.released());
    expect_no_denser_than_chance(run, bounded, packing);
  }
}

TEST_P(SampleBounds, drag_delivered_is_drag_due) {
  // Of what was due, a solver that let the drag act on the fill of the base node delivered 76 % after 10 s on real
  // ground, and 12 % after 20 s (docs/notes/bed-and-contact.md).
  for (const BoundedScene& bounded : {bounded_scenes[0], bounded_scenes[1]}) {
    SampleRun run(bounded.scene(), GetParam());
    double delivered = 0, due = 0, least = 1;
    for (int n = 1; n * bounded.interval <= bounded.end; ++n) {
      const double time = n * bounded.interval;
      run.run_to(time);
      const Drag drag = drag_of(run, GetParam());
      delivered += drag.delivered;
      due += drag.due;
      least = std::min(least, drag.delivered / drag.due);
      EXPECT_LT(drag.delivered, 1.02 * drag.whole) << bounded.name << " at " << time << " s";
    }
    // By what share of their bed the rim's columns are covered is known to some 10 % of the drag: a rim that thins out
    // is covered more than its mass says. Bumps throw up a part of the flow.
    EXPECT_NEAR(delivered / due, 1, 0.1) << bounded.name;
    EXPECT_GT(least, 0.85) << bounded.name;
  }
}

/// A flow on rough ground hops. Columns that took drag only in the steps in which they press delivered 0.96, 0.75, 0.55
/// and 0.44 of the drag due in steps of 20, 5, 2 and 0.1 ms.
TEST_P(SampleBounds, drag_delivered_is_drag_due_whatever_the_step) {
  SampleRun run(rough_slope_scene(), GetParam());
  run.run_to(6);
  for (const double share : {1.0, 0.1, 0.01}) {
    const Drag drag = drag_of(run, GetParam(), share);
    EXPECT_NEAR(drag.delivered / drag.due, 1, 0.1) << share << " of the CFL step";
  }
}

/// A map of cells twice as wide, cell by cell of the finer one.
std::vector<double> on_half_cells(const std::vector<double>& map, int columns, int rows) {
  std::vector<double> fine;
  for (int j = 0; j < 2 * rows; ++j)
    for (int i = 0; i < 2 * columns; ++i) fine.push_back(map[static_cast<std::size_t>(j / 2 * columns + i / 2)]);
  return fine;
}

class SampleFootprint : public InEachPlace {
 protected:
  struct Flow {
    const char* name;
    SampleScene scene;
    double end;  ///< [s]
    /// The least share in common with other friction inside, other layers and cells of twice the width.
    double by_friction, by_layers, by_cells;
  };
  static std::vector<double> peak(const SampleScene& scene, double end) {
    SampleRun run(scene, GetParam());
    run.run_to(end);
    return run.peak_thickness();
  }
  /// The share of the footprint that another scene has in common with one [peak thickness of the flow, 0.1 m].
  static double common(const Flow& flow, const std::vector<double>& as_is, const SampleScene& other) {
    return common_cover(as_is, peak(other, flow.end), 0.1);
  }
  /// Runs a flow again with other friction inside, other layers and other cells.
  static void compare(const Flow& flow) {
    const auto as_is = peak(flow.scene, flow.end);
    SampleScene other = flow.scene;
    for (const double friction : {30.0, 45.0}) {
      other.options.material.friction_angle = friction;
      EXPECT_GT(common(flow, as_is, other), flow.by_friction) << flow.name << ", " << friction << " deg";
    }
    other = flow.scene;
    other.layer_height *= 2;
    EXPECT_GT(common(flow, as_is, other), flow.by_layers) << flow.name;
    other = flow.scene;
    other.cell *= 2;
    SampleRun coarse(other, GetParam());
    coarse.run_to(flow.end);
    const auto there = on_half_cells(coarse.peak_thickness(), coarse.map().columns, coarse.map().rows);
    EXPECT_GT(common_cover(as_is, there, 0.1), flow.by_cells) << flow.name;
  }
};
TALUS_IN_EACH_PLACE(SampleFootprint);

TEST_P(SampleFootprint, of_a_thin_flow_is_that_of_the_terrain) {
  // A coarse cell counts as covered where a part of it is.
  compare({"rough slope", rough_slope_scene(), 10, 0.97, 0.97, 0.83});
}

TEST_P(SampleFootprint, in_a_gully_is_that_of_the_terrain) {
  // This flow is deeper, and climbs the bends a little otherwise.
  compare({"bent gully", bent_gully_scene(), 16, 0.9, 0.97, 0.8});
}

class SampleCliff : public InEachPlace {
 protected:
  static constexpr double edge = 150, foot = 160, brink = 210;  ///< along the terrain's own axis [m]

  /// Sums over what falls.
  struct Fall {
    double flying = 0, acceleration = 0;  ///< upward, out of reach of what has landed [m/s2]
    double low = 0, speed_share = 0;      ///< just above that: speed over that of a free fall from the edge
  };

  /// The method adds what fell freely between two instants.
  static void add_flight(const std::map<int, PointSeen>& was, const std::vector<PointSeen>& points, double interval,
                         Fall& sums) {
    for (const PointSeen& is : points) {
      const PointSeen& then = was.at(is.part);
      if (then.height < 12 || is.height < 12 || then.x < edge) continue;
      sums.flying += 1;
      sums.acceleration += (is.upward - then.upward) / interval;
    }
  }
  /// The points by all smallest parts that they hold: where a part of a point was that has been split since.
  static std::map<int, PointSeen> by_part(const std::vector<PointSeen>& points) {
    std::map<int, PointSeen> all;
    for (const PointSeen& p : points)
      for (int part = p.part; part < p.part + p.parts; ++part) all.emplace(part, p);
    return all;
  }
  /// The method notes the energy of what is still on the slope, and adds what has nearly fallen.
  static void add_arrival(const std::vector<PointSeen>& points, std::map<int, double>& at_edge, Fall& sums) {
    for (const PointSeen& p : points) {
      const double energy = 0.5 * p.speed * p.speed + g * p.z;  // per mass
      for (int part = p.part; p.x < edge && part < p.part + p.parts; ++part) at_edge[part] = energy;
      if (p.x < edge || p.height < 6 || p.height > 9) continue;
      sums.low += 1;
      sums.speed_share += p.speed / std::sqrt(2 * (at_edge.at(p.part) - g * p.z));
    }
  }
  /// The share of the volume between two places.
  static double between(const std::vector<PointSeen>& points, double from, double to) {
    double volume = 0, all = 0;
    for (const PointSeen& p : points) {
      all += p.volume;
      volume += p.x >= from && p.x < to ? p.volume : 0;
    }
    return volume / all;
  }
};
TALUS_IN_EACH_PLACE(SampleCliff);

TEST_P(SampleCliff, what_goes_over_a_cliff_falls_freely_and_lands_on_the_bench) {
  SampleRun run(cliff_bench_scene(), GetParam());
  constexpr double interval = 0.1;
  std::map<int, double> at_edge;
  std::map<int, PointSeen> was = by_part(run.points());
  Fall sums;
  for (int n = 1; n <= 75; ++n) {  // until a heap has grown at the foot
    run.run_to(n * interval);
    const std::vector<PointSeen> is = run.points();
    add_flight(was, is, interval, sums);
    add_arrival(is, at_edge, sums);
    was = by_part(is);
  }
  const double acceleration = sums.acceleration / sums.flying, share = sums.speed_share / sums.low;
  EXPECT_GT(sums.flying, 1000);
  EXPECT_NEAR(acceleration, -g, 0.02 * g);
  // The edge, which cells of 5 m round off, costs some speed.
  EXPECT_GT(sums.low, 300);
  EXPECT_GT(share, 0.96);
  EXPECT_LT(share, 1.01);
}

TEST_P(SampleCliff, the_mass_comes_to_lie_on_the_bench_and_below_it) {
  SampleRun run(cliff_bench_scene(), GetParam());
  run.run_to(30);
  const auto end = run.points();
  EXPECT_GT(between(end, foot, brink), 0.7);
  EXPECT_GT(between(end, brink, 1e9), 0.1);
  EXPECT_LT(between(end, 0, foot), 1e-3) << "something hangs on the cliff, or above it";
}

constexpr LaidScene laid_scenes[] = {{"rough slope", rough_slope_scene, 5},
                                     {"bent gully", bent_gully_scene, 14},
                                     {"cliff and bench", cliff_bench_scene, 9},
                                     {"thinning slide", thinning_slide_scene, 30}};

class SampleSymmetry : public InEachPlace {
 protected:
  static SampleRun run_of(const LaidScene& laid, const samples::Pose& pose) {
    SampleScene scene = laid.scene();
    scene.pose = pose;
    return {scene, GetParam()};
  }
  /// The area of the footprint, thicker than 0.1 m at some time [m2].
  static double area_of(const SampleRun& run) {
    double cells = 0;
    for (const double t : run.peak_thickness()) cells += t > 0.1;
    return cells * run.map().cell * run.map().cell;
  }
  /// The largest difference of two runs' thickness over the largest; cell (i, j) of a is cell place(i, j) of b.
  template <class Place>
  static double difference(const SampleRun& a, const SampleRun& b, const Place& place) {
    const std::vector<double> map = a.thickness(), other = b.thickness();
    double worst = 0, most = 0;
    for (int j = 0; j < a.map().rows; ++j) {
      for (int i = 0; i < a.map().columns; ++i) {
        const auto [column, row] = place(i, j);
        const double t = map[a.map().index(i, j)];
        worst = std::max(worst, std::abs(t - other[b.map().index(column, row)]));
        most = std::max(most, t);
      }
    }
    return worst / most;
  }
};
TALUS_IN_EACH_PLACE(SampleSymmetry);

TEST_P(SampleSymmetry, mirrored_and_quarter_turned_terrain_gives_the_same_slide) {
  for (const LaidScene& laid : laid_scenes) {
    SampleRun as_is = run_of(laid, {}), mirrored = run_of(laid, {true, 0}), turned = run_of(laid, {false, 90});
    for (SampleRun* run : {&as_is, &mirrored, &turned}) run->run_to(laid.end);
    const int rows = as_is.map().rows;
    const double by_mirror = difference(as_is, mirrored, [&](int i, int j) { return std::pair(i, rows - 1 - j); });
    const double by_turn = difference(as_is, turned, [&](int i, int j) { return std::pair(rows - 1 - j, i); });
    // Sums in another order: rounding, grown in the flow.
    EXPECT_LT(by_mirror, 1e-8) << laid.name;
    EXPECT_LT(by_turn, 1e-8) << laid.name;
  }
}

TEST_P(SampleSymmetry, obliquely_turned_terrain_gives_the_same_slide_within_a_cell) {
  for (const LaidScene& laid : laid_scenes) {
    SampleRun as_is = run_of(laid, {}), turned = run_of(laid, {false, 30});
    for (SampleRun* run : {&as_is, &turned}) run->run_to(laid.end);
    const auto a = as_is.points(), b = turned.points();
    const Mean ma = mean_of(a), mb = mean_of(b);
    const double cell = as_is.map().cell, centre = std::hypot(mb.x - ma.x, mb.y - ma.y) / cell;
    const double reach = (reach_of(b, 0.99) - reach_of(a, 0.99)) / cell, area = area_of(turned) / area_of(as_is) - 1;
    const double energy = mb.half_square / ma.half_square - 1;
    EXPECT_LT(centre, 0.2) << laid.name;
    EXPECT_LT(std::abs(reach), 0.75) << laid.name;
    EXPECT_LT(std::abs(area), 0.05) << laid.name;
    if (ma.half_square > 10) {  // while it moves
      EXPECT_LT(std::abs(energy), 0.03) << laid.name;
    }
    EXPECT_NEAR(ma.volume / mb.volume, 1, 0.02) << laid.name;  // the release on other cells
  }
}

}  // namespace
}  // namespace talus::solver::testing
