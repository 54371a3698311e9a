// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky against conjugate gradients on random points, states and constraints: its analysis, what it reports, what it
// refuses.
#include "solver/linear/direct/cholesky_solver.hpp"

#include "solver/linear/direct/csr_assembly.hpp"
#include "solver/linear/direct/csr_matrix.hpp"
#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

class CholeskyOfTangents : public InEachPlace {
 protected:
  template <class Real, class Device, class Shape>
  static void compare_solvers() {
    for (const auto mapping : {Mapping::terrain_following, Mapping::cartesian}) {
      LinearBench<Real, Device, Shape> bench({kind_of<Shape>, mapping});
      EXPECT_LT(difference(bench.by_cholesky(), bench.by_gradients()), 1e-8);
    }
  }

  template <class Real, class Device, class Shape>
  static void keep_analysis() {
    LinearBench<Real, Device, Shape> bench({kind_of<Shape>});
    CholeskySolver<Real, Device, Shape> solver(bench.device);
    NodeVector<Device> x(bench.device);
    const NodeVector<Device> b = bench.right_side();
    const auto solve = [&] { EXPECT_TRUE(solver.solve(bench.from(), bench.held(), b, x).converged); };
    solver.begin_step(bench.elements);
    solve();
    const auto first = x.download();
    bench.inertia *= 2;  // another matrix of the same pattern, elements and unknowns as they were
    solve();
    EXPECT_EQ(solver.factor().analyses(), 1);
    EXPECT_EQ(solver.assembly().sorts(), 1);
    EXPECT_GT(difference(x.download(), first), 1e-3);
    bench.elements.build(bench.grid.view(), bench.points.view());
    solver.begin_step(bench.elements);  // a new step in which no point changes its cell
    solve();
    EXPECT_EQ(solver.factor().analyses(), 1);
    EXPECT_EQ(solver.assembly().sorts(), 2);
    bench.free_all();  // more unknowns
    solve();
    EXPECT_EQ(solver.factor().analyses(), 2);
    ElementList<Real, Device, Shape> list(bench.device);
    list.build(bench.grid.view(), bench.points.view());
    const double foreseen = assembly_bytes<Real, Shape>(list.count(), solver.assembly().unknown_nodes());
    EXPECT_GT(foreseen, static_cast<double>(solver.bytes()));
    EXPECT_LT(foreseen, 2 * static_cast<double>(solver.bytes()));
  }

  template <class Real, class Device, class Shape>
  static void report_indefinite() {
    LinearBench<Real, Device, Shape> bench({kind_of<Shape>});
    CholeskySolver<Real, Device, Shape> solver(bench.device);
    NodeVector<Device> x(bench.device);
    const NodeVector<Device> b = bench.right_side();
    solver.begin_step(bench.elements);
    bench.inertia = -1e5;
    const LinearReport report = solver.solve(bench.from(), bench.held(), b, x);
    EXPECT_TRUE(report.indefinite);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(norm(x.download()), 0);
    bench.inertia = 1e3;  // the same solver goes on
    EXPECT_TRUE(solver.solve(bench.from(), bench.held(), b, x).converged);
  }

  /// A body without support, pulled by a force, has no static equilibrium: its matrix is singular.
  template <class Real, class Device, class Shape>
  static void report_singular() {
    Setting setting{kind_of<Shape>};
    Scene scene = random_scene(setting);
    for (auto& strain : scene.points.elastic) std::fill(strain.begin(), strain.end(), 0.0);
    std::fill(scene.points.log_volume.begin(), scene.points.log_volume.end(), 0.0);
    LinearBench<Real, Device, Shape> bench(scene, setting);
    bench.free_all();
    bench.inertia = 0;
    CholeskySolver<Real, Device, Shape> solver(bench.device);
    NodeVector<Device> b(bench.device), x(bench.device);
    const auto m = bench.mass.download();
    std::vector<Vec3<double>> weight(m.size());
    for (std::size_t n = 0; n < m.size(); ++n) weight[n] = {0, 0, -9.81 * m[n]};
    b.upload(weight);
    solver.begin_step(bench.elements);
    const LinearReport report = solver.solve(bench.from(), bench.held(), b, x);
    EXPECT_TRUE(report.indefinite) << "residual " << report.residual;
    EXPECT_FALSE(report.converged);
  }

  template <class Real, class Device, class Shape>
  static void refuse(double limit, const std::string& what) {
    LinearBench<Real, Device, Shape> bench({kind_of<Shape>});
    CholeskySolver<Real, Device, Shape> solver(bench.device, limit);
    NodeVector<Device> x(bench.device);
    const NodeVector<Device> b = bench.right_side();
    solver.begin_step(bench.elements);
    const std::size_t before = solver.bytes();
    try {
      solver.solve(bench.from(), bench.held(), b, x);
      ADD_FAILURE() << "a matrix was built in spite of a limit of " << limit << " bytes";
    } catch (const NumericalError& e) {
      EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(" MB"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("linear_solver = \"pcg\""), std::string::npos) << e.what();
    }
    EXPECT_LT(solver.bytes(), before + 100000) << "memory was taken first";
  }
};

TEST_P(CholeskyOfTangents, cholesky_finds_the_displacement_that_conjugate_gradients_find) {
  TALUS_RUN(compare_solvers);
}
TEST_P(CholeskyOfTangents, cholesky_keeps_its_analysis_while_the_pattern_stands) { TALUS_RUN(keep_analysis); }
TEST_P(CholeskyOfTangents, cholesky_says_that_a_matrix_is_indefinite) { TALUS_RUN(report_indefinite); }
TEST_P(CholeskyOfTangents, cholesky_says_that_a_floating_body_has_no_equilibrium) { TALUS_RUN(report_singular); }
TEST_P(CholeskyOfTangents, cholesky_refuses_a_matrix_that_does_not_fit_before_it_is_built) {
  TALUS_RUN(refuse, 1e4, "the triples and the matrix would take");
}

TEST_P(CholeskyOfTangents, cholesky_refuses_a_factor_that_does_not_fit) {
  // A limit between the matrix's need and the factor's: the factorisation alone, on a full matrix.
  const auto run = [](const auto& device) {
    using Device = std::decay_t<decltype(device)>;
    constexpr int n = 60;
    CsrMatrix<Device> a(device);
    a.rows = n;
    a.pattern = 1;
    std::vector<int> starts{0}, columns;
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        columns.push_back(j);
        values.push_back(i == j ? 2.0 * n : 1.0);
      }
      starts.push_back(static_cast<int>(columns.size()));
    }
    a.starts.upload(starts);
    a.columns.upload(columns);
    a.values.upload(values);
    Buffer<double, Device> b(device), x(device);
    b.upload(std::vector<double>(n, 1.0));
    EXPECT_THROW(make_cholesky(device, 1000.0)->solve(a, b, x), NumericalError);
    EXPECT_TRUE(make_cholesky(device)->solve(a, b, x));
    EXPECT_NEAR(x.download().front(), 1.0 / (3 * n - 1), 1e-14);
  };
  GetParam() == On::gpu ? run(GpuDevice::make()) : run(CpuDevice::make());
}

TALUS_IN_EACH_PLACE(CholeskyOfTangents);

#if TALUS_FOR_GPU
class CholeskyOnBothDevices : public InEachPlace {
 protected:
  template <class Shape>
  static void compare() {
    LinearBench<double, CpuDevice, Shape> cpu({kind_of<Shape>});
    LinearBench<double, GpuDevice, Shape> gpu({kind_of<Shape>});
    EXPECT_LT(difference(gpu.by_cholesky(), cpu.by_cholesky()), 1e-8);
  }
};
TEST_P(CholeskyOnBothDevices, give_the_same_displacements) {
  compare<Linear>();
  compare<Quadratic>();
  compare<Gimp>();
}
INSTANTIATE_TEST_SUITE_P(places, CholeskyOnBothDevices, ::testing::Values(On::gpu), place_name);
#endif

}  // namespace
}  // namespace talus::solver::testing
