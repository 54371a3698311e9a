// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run must give again: the same bits where that is promised, the same slide elsewhere.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Two metres of sand on a plane that falls by 0.6.
Domain block_on_a_plane() {
  Domain d = ground(30, 20, 1.0, 0.5, [](double x, double) { return 12 - 0.6 * x; });
  fill(d, {4, 9, 6, 12, 0, 2});
  return d;
}

TEST(Repeatability, gives_the_same_bits_on_every_cpu_run) {
  const Domain d = block_on_a_plane();
  const SolveOptions o;
  const Scene scene = make_scene(d, o);
  const auto once = make_solver(scene, o, On::cpu), again = make_solver(scene, o, On::cpu);
  run_to(*once, 1.0);
  run_to(*again, 1.0);
  const ParticleState a = once->state().points, b = again->state().points;
  ASSERT_EQ(a.id, b.id);
  EXPECT_EQ(a.velocity[0], b.velocity[0]);
  EXPECT_EQ(a.offset[2], b.offset[2]);
  EXPECT_EQ(a.log_volume, b.log_volume);
}

/// Dense grains under mu(I), which dilate as they slide.
SolveOptions dense_grains() {
  SolveOptions o;
  o.material.model = MaterialModel::mu_of_i;
  o.material.grain_diameter = 0.05;
  o.material.volume_fraction = 0.63;
  return o;
}

TEST(Repeatability, resumes_to_the_same_bits) {
  const Domain d = block_on_a_plane();
  SolveOptions single;
  single.precision = Precision::single_;
  for (const SolveOptions& o : {SolveOptions{}, single, dense_grains()}) {
    const Scene scene = make_scene(d, o);
    const auto unbroken = make_solver(scene, o, On::cpu);
    unbroken->set_next_event(1.0);
    BatchReport batch;
    do {
      batch = unbroken->advance();
    } while (!batch.sorted || batch.clock.time < 0.4);
    const auto resumed = resume_solver(scene, o, On::cpu, unbroken->state());
    run_to(*unbroken, 1.0);
    run_to(*resumed, 1.0);
    const ParticleState a = unbroken->state().points, b = resumed->state().points;
    ASSERT_EQ(a.id, b.id);
    EXPECT_EQ(a.velocity[2], b.velocity[2]);
    EXPECT_EQ(a.offset[0], b.offset[0]);
    EXPECT_EQ(a.elastic[5], b.elastic[5]);
    EXPECT_EQ(a.plastic_log_volume, b.plastic_log_volume);
    EXPECT_EQ(unbroken->state().maps.peak_speed, resumed->state().maps.peak_speed);
  }
}

TEST(Places, agree_on_grains_that_dilate) {
  if (!gpu_available()) {
    if (std::getenv("TALUS_REQUIRE_GPU") != nullptr) FAIL() << "TALUS_REQUIRE_GPU is set, but no GPU can be used";
    GTEST_SKIP() << "no GPU on this machine";
  }
  const SolveOptions o = dense_grains();
  const Scene scene = make_scene(block_on_a_plane(), o);
  const auto volume = [&](On on) {
    const auto solver = make_solver(scene, o, on);
    run_to(*solver, 0.2);
    double sum = 0;
    for (const double log_volume : solver->state().points.plastic_log_volume) sum += std::exp(log_volume) - 1;
    return sum;
  };
  const double dilated = volume(On::cpu);
  EXPECT_GT(dilated, 0);
  // Returns end within 1e-9 of one another where rounding differs.
  EXPECT_NEAR(volume(On::gpu) / dilated, 1, 1e-6);
}

TEST(Places, agree_on_a_slide) {
  if (!gpu_available()) {
    if (std::getenv("TALUS_REQUIRE_GPU") != nullptr) FAIL() << "TALUS_REQUIRE_GPU is set, but no GPU can be used";
    GTEST_SKIP() << "no GPU on this machine";
  }
  Domain d = ground(30, 20, 1.0, 0.5, [](double x, double y) { return 12 - 0.6 * x + 0.3 * std::sin(0.4 * y); });
  fill(d, {4, 9, 6, 12, 0, 2});
  for (const auto shape : {ShapeKind::quadratic, ShapeKind::gimp, ShapeKind::linear}) {
    for (const auto transfer : {Transfer::apic, Transfer::flip}) {
      SolveOptions o;
      o.shape = shape;
      o.transfer = transfer;
      if (transfer == Transfer::flip) o.stress_update = StressUpdate::modified;
      const Scene scene = make_scene(d, o);
      const auto cpu = make_solver(scene, o, On::cpu), gpu = make_solver(scene, o, On::gpu);
      // Before rounding has had time to grow in the flow: the same numbers.
      run_to(*cpu, 0.2);
      run_to(*gpu, 0.2);
      const Energies a = cpu->energies(), b = gpu->energies();
      EXPECT_NEAR(b.kinetic / a.kinetic, 1, 1e-9);
      EXPECT_NEAR(b.potential / a.potential, 1, 1e-9);
      // Later: the same slide.
      run_to(*cpu, 2.0);
      run_to(*gpu, 2.0);
      const Centre ca = centre(*cpu, scene), cb = centre(*gpu, scene);
      EXPECT_NEAR(cb.x, ca.x, 0.01);
      EXPECT_NEAR(cb.z, ca.z, 0.01);
    }
  }
}

class Repeatable : public InEachPlace {
 protected:
  /// A heap that collapses on a slope until it has crossed several blocks of columns.
  static SolverState collapse(bool deterministic, Precision precision, ShapeKind shape,
                              Integrator integrator = Integrator::explicit_) {
    Domain d = ground(64, 48, 1.0, 1.0, [](double x, double y) { return 0.3 * x + 0.1 * y; });
    fill(d, {30, 44, 14, 30, 0, 5});
    SolveOptions o;
    o.precision = precision;
    o.integrator = integrator;
    o.shape = shape;
    o.material.youngs_modulus = 1e6;
    o.base.friction_angle = 12;
    o.deterministic = deterministic;
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    run_to(*solver, 2);
    return solver->state();
  }
};

TEST_P(Repeatable, gives_the_same_bits_on_every_run) {
  for (const auto& [precision, integrator] : {std::pair{Precision::double_, Integrator::explicit_},
                                              {Precision::single_, Integrator::explicit_},
                                              {Precision::double_, Integrator::column_implicit}}) {
    for (const ShapeKind shape : {ShapeKind::quadratic, ShapeKind::gimp}) {
      SCOPED_TRACE(name_of(shape));
      const SolverState a = collapse(true, precision, shape, integrator),
                        b = collapse(true, precision, shape, integrator);
      EXPECT_EQ(a.clock.step, b.clock.step);
      EXPECT_EQ(a.clock.time, b.clock.time);
      EXPECT_EQ(a.points.id, b.points.id);
      for (int q = 0; q < 3; ++q) {
        EXPECT_EQ(a.points.offset[q], b.points.offset[q]);
        EXPECT_EQ(a.points.velocity[q], b.points.velocity[q]);
      }
      for (int q = 0; q < 6; ++q) EXPECT_EQ(a.points.elastic[q], b.points.elastic[q]);
      EXPECT_EQ(a.maps.peak_speed, b.maps.peak_speed);
      EXPECT_EQ(a.maps.peak_thickness, b.maps.peak_thickness);
    }
  }
}

TEST_P(Repeatable, differs_from_the_usual_order_by_rounding_alone) {
  const SolverState a = collapse(true, Precision::double_, ShapeKind::quadratic),
                    b = collapse(false, Precision::double_, ShapeKind::quadratic);
  const auto moments = [](const SolverState& s) {
    std::vector<double> sums(4);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      for (int q = 0; q < 3; ++q)
        sums[static_cast<std::size_t>(q)] += (s.points.cell[q][p] + s.points.offset[q][p]) * s.points.volume[p];
      sums[3] += s.points.volume[p];
    }
    return sums;
  };
  const auto x = moments(a), y = moments(b);
  for (std::size_t q = 0; q < 3; ++q)
    EXPECT_NEAR(x[q] / x[3], y[q] / y[3], 1e-6);  // cells; rounding grows as sand flows
}

TALUS_IN_EACH_PLACE(Repeatable);

}  // namespace
}  // namespace talus::solver::testing
