// The tangent's three forms against one another, and Cholesky against conjugate gradients, on random points, states and
// constraints.
#include <array>
#include <set>

#include "common/error.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/linear/direct/elimination_order.hpp"
#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

class LinearSystem : public InEachPlace {
 protected:
  template <class Real, class Device, class Shape>
  static void compare_forms(double tolerance) {
    for (const auto mapping : {Mapping::terrain_following, Mapping::cartesian}) {
      for (const auto model : {MaterialModel::hencky, MaterialModel::drucker_prager}) {
        LinearBench<Real, Device, Shape> bench({kind_of<Shape>, mapping, model});
        const auto expected = bench.product(Operator::points);
        EXPECT_GT(norm(expected), 0);
        EXPECT_LT(difference(bench.product(Operator::elements), expected), tolerance);
        EXPECT_LT(difference(bench.product(Operator::stencil), expected), tolerance);
        // Rounded to 2^-24 each, and the stencil's sums on the way: a part in a million, but not none.
        for (const auto form : {Operator::points, Operator::stencil}) {
          const double rounding = difference(bench.product(form, true), expected);
          EXPECT_LT(rounding, 1e-6);
          if constexpr (std::is_same_v<Real, double>) {
            EXPECT_GT(rounding, 1e-12) << "stored in double after all";
          }
        }
      }
    }
  }

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
    CholeskySolver<Real, Device, Shape> solver;
    NodeVector<Device> x;
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
    ElementList<Real, Device, Shape> list;
    list.build(bench.grid.view(), bench.points.view());
    const double foreseen = assembly_bytes<Real, Shape>(list.count(), solver.assembly().unknown_nodes());
    EXPECT_GT(foreseen, static_cast<double>(solver.bytes()));
    EXPECT_LT(foreseen, 2 * static_cast<double>(solver.bytes()));
  }

  template <class Real, class Device, class Shape>
  static void report_indefinite() {
    LinearBench<Real, Device, Shape> bench({kind_of<Shape>});
    CholeskySolver<Real, Device, Shape> solver;
    NodeVector<Device> x;
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
    CholeskySolver<Real, Device, Shape> solver;
    NodeVector<Device> b, x;
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
    CholeskySolver<Real, Device, Shape> solver(limit);
    NodeVector<Device> x;
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

// Rounding only: the sums run over the same terms in another order.
TEST_P(LinearSystem, products_of_elements_and_stencil_are_those_of_the_points) {
  TALUS_RUN(compare_forms, 1e-12);
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) {
    compare_forms<float, GpuDevice, Linear>(1e-5);
    compare_forms<float, GpuDevice, Quadratic>(1e-5);
    compare_forms<float, GpuDevice, Gimp>(1e-5);
    return;
  }
#endif
  compare_forms<float, CpuDevice, Linear>(1e-5);
  compare_forms<float, CpuDevice, Quadratic>(1e-5);
  compare_forms<float, CpuDevice, Gimp>(1e-5);
}

TEST_P(LinearSystem, cholesky_finds_the_displacement_that_conjugate_gradients_find) { TALUS_RUN(compare_solvers); }
TEST_P(LinearSystem, cholesky_keeps_its_analysis_while_the_pattern_stands) { TALUS_RUN(keep_analysis); }
TEST_P(LinearSystem, cholesky_says_that_a_matrix_is_indefinite) { TALUS_RUN(report_indefinite); }
TEST_P(LinearSystem, cholesky_says_that_a_floating_body_has_no_equilibrium) { TALUS_RUN(report_singular); }
TEST_P(LinearSystem, cholesky_refuses_a_matrix_that_does_not_fit_before_it_is_built) {
  TALUS_RUN(refuse, 1e4, "the triples and the matrix would take");
}

TEST_P(LinearSystem, cholesky_refuses_a_factor_that_does_not_fit) {
  // A limit between the matrix's need and the factor's: the factorisation alone, on a full matrix.
  const auto run = [](auto place) {
    using Device = decltype(place);
    constexpr int n = 60;
    CsrMatrix<Device> a;
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
    Buffer<double, Device> b, x;
    b.upload(std::vector<double>(n, 1.0));
    EXPECT_THROW(make_cholesky(place, 1000.0)->solve(a, b, x), NumericalError);
    EXPECT_TRUE(make_cholesky(place)->solve(a, b, x));
    EXPECT_NEAR(x.download().front(), 1.0 / (3 * n - 1), 1e-14);
  };
  GetParam() == On::gpu ? run(GpuDevice{}) : run(CpuDevice{});
}

TALUS_IN_EACH_PLACE(LinearSystem);

#if TALUS_FOR_GPU
class BothPlaces : public InEachPlace {
 protected:
  template <class Shape>
  static void compare() {
    LinearBench<double, CpuDevice, Shape> cpu({kind_of<Shape>});
    LinearBench<double, GpuDevice, Shape> gpu({kind_of<Shape>});
    for (const auto form : {Operator::points, Operator::elements, Operator::stencil}) {
      EXPECT_LT(difference(gpu.product(form), cpu.product(form)), 1e-11);
    }
    EXPECT_LT(difference(gpu.by_cholesky(), cpu.by_cholesky()), 1e-8);
  }
};
TEST_P(BothPlaces, give_the_same_products_and_displacements) {
  compare<Linear>();
  compare<Quadratic>();
  compare<Gimp>();
}
INSTANTIATE_TEST_SUITE_P(places, BothPlaces, ::testing::Values(On::gpu), place_name);
#endif

template <class Shape>
void check_elements() {
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list;
  list.build(bench.grid.view(), bench.points.view());
  const ElementView v = list.view();
  constexpr int each = ElementList<double, CpuDevice, Shape>::nodes_each;
  std::vector<int> seen(static_cast<std::size_t>(bench.points.count()));
  int folded = 0;
  for (int e = 0; e < v.count; ++e) {
    EXPECT_LT(v.starts[e], v.starts[e + 1]);
    folded += v.nodes[e * each] == v.nodes[e * each + 1] ? 1 : 0;
    for (int s = v.starts[e]; s < v.starts[e + 1]; ++s) {
      const PointGradients<double, Shape> g(bench.grid.view(), bench.points.view(), v.order[s]);
      ++seen[static_cast<std::size_t>(v.order[s])];
      int local = 0;
      around(bench.grid.view(), g, [&](int n, int, int, int) { EXPECT_EQ(n, v.nodes[e * each + local++]); });
    }
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
  EXPECT_EQ(folded > 0, Shape::width == 3);
  int grouped = 0;
  for (const auto& colour : list.groups().ranges) {
    std::set<int> taken;  // by earlier ranges of this colour
    for (const auto& [begin, end] : colour) {
      std::set<int> mine(v.nodes + begin * each, v.nodes + end * each);
      for (const int n : mine) EXPECT_EQ(taken.count(n), 0u);
      taken.insert(mine.begin(), mine.end());
      grouped += end - begin;
    }
  }
  EXPECT_EQ(grouped, v.count);
}

TEST(Elements, hold_every_point_once_and_share_no_node_within_a_colour) {
  check_elements<Linear>();
  check_elements<Quadratic>();
  check_elements<Gimp>();
}

/// Column, row and layer of every stored node.
template <class Shape>
std::vector<std::array<int, 3>> node_places(const LinearBench<double, CpuDevice, Shape>& bench) {
  const auto grid = bench.grid.view();
  std::vector<std::array<int, 3>> places(static_cast<std::size_t>(bench.count));
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const BlockSlot& slot = grid.slot(i, j);
      for (int k = slot.first_layer; slot.offset >= 0 && k < slot.first_layer + slot.layers; ++k) {
        places[static_cast<std::size_t>(grid.node(slot, i, j, k))] = {i, j, k};
      }
    }
  }
  return places;
}

template <class Shape>
void check_neighbours() {
  constexpr int reach = Shape::width - 1, side = 2 * reach + 1;
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list;
  StencilMatrix<double, CpuDevice, Shape> matrix;
  list.build(bench.grid.view(), bench.points.view());
  matrix.build(list, bench.count);
  const auto places = node_places(bench);
  const auto view = matrix.view();
  EXPECT_GT(view.rows, 50);
  for (int row = 0; row < view.rows; ++row) {
    const auto& mine = places[static_cast<std::size_t>(view.node_of[row])];
    EXPECT_EQ(view.row_of[view.node_of[row]], row);
    for (int q = 0; q < side * side * side; ++q) {
      const int n = view.table[view.table_at(row, q)];
      if (n < 0) continue;
      const std::array<int, 3> expected{mine[0] + q / side % side - reach, mine[1] + q / (side * side) - reach,
                                        mine[2] + q % side - reach};
      EXPECT_EQ(places[static_cast<std::size_t>(n)], expected) << "row " << row << ", neighbour " << q;
    }
  }
}

TEST(Stencil, finds_each_neighbour_where_it_stands) {
  check_neighbours<Linear>();
  check_neighbours<Quadratic>();
  check_neighbours<Gimp>();
}

/// Keeps the blocks it is handed.
template <int nodes>
struct Keep {
  double* blocks;
  void put(int e, int a, int b, const double* block) const {
    std::copy(block, block + 9, blocks + ((static_cast<std::size_t>(e) * nodes + a) * nodes + b) * 9);
  }
};

template <class Shape>
void check_tiles() {
  constexpr int w = Shape::width, nodes = w * w * w;
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list;
  list.build(bench.grid.view(), bench.points.view());
  const auto size = static_cast<std::size_t>(list.count()) * nodes * nodes * 9;
  std::vector<double> whole(size), slices(size);
  sum_elements<double, CpuDevice, Shape>(list, bench.from(), Keep<nodes>{whole.data()});
  using Slice = SumElements<double, Shape, 1, w * w, Keep<nodes>>;
  const Slice slice{bench.from(), list.view(), {slices.data()}};
  for (int i = 0; i < list.count() * Slice::tiles; ++i) slice(i);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    worst = std::max(worst, std::abs(whole[i] - slices[i]));
    largest = std::max(largest, std::abs(whole[i]));
  }
  EXPECT_LT(worst, 1e-13 * largest);
}

TEST(Elements, are_the_same_from_the_tiles_of_the_gpu) {
  check_tiles<Linear>();
  check_tiles<Quadratic>();
  check_tiles<Gimp>();
}

TEST(Elements, sum_the_same_on_every_run) {
  LinearBench<double, CpuDevice, Quadratic> bench({ShapeKind::quadratic});
  for (const auto form : {Operator::elements, Operator::stencil}) {
    const auto a = bench.product(form), b = bench.product(form);
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_TRUE(a[n].x == b[n].x && a[n].y == b[n].y && a[n].z == b[n].z);
  }
}

TEST(EliminationOrder, renumbers_rows_and_columns_alike) {
  // Nodes 0 - 1 - 2 in a chain, three rows each.
  const std::vector<std::vector<int>> neighbours{{0, 1}, {0, 1, 2}, {1, 2}};
  HostPattern a;
  a.starts.push_back(0);
  std::vector<double> values;
  const auto value = [](int row, int column) { return 100.0 * std::min(row, column) + std::max(row, column); };
  for (int row = 0; row < 9; ++row) {
    for (const int n : neighbours[static_cast<std::size_t>(row / 3)]) {
      for (int j = 0; j < 3; ++j) {
        a.columns.push_back(3 * n + j);
        values.push_back(value(row, 3 * n + j));
      }
    }
    a.starts.push_back(static_cast<int>(a.columns.size()));
  }
  const HostPattern graph = graph_of_nodes(a);
  EXPECT_EQ(graph.starts, (std::vector<int>{0, 2, 5, 7}));
  EXPECT_EQ(graph.columns, (std::vector<int>{0, 1, 0, 1, 2, 1, 2}));
  const Renumbered r = renumber(a, {2, 0, 1});
  EXPECT_EQ(r.order, (std::vector<int>{6, 7, 8, 0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(r.source.size(), values.size());
  for (std::size_t row = 0; row < 9; ++row) {
    for (auto k = static_cast<std::size_t>(r.pattern.starts[row]);
         k < static_cast<std::size_t>(r.pattern.starts[row + 1]); ++k) {
      const auto column = static_cast<std::size_t>(r.pattern.columns[k]);
      EXPECT_EQ(values[static_cast<std::size_t>(r.source[k])], value(r.order[row], r.order[column]));
      if (k > static_cast<std::size_t>(r.pattern.starts[row])) {
        EXPECT_LT(r.pattern.columns[k - 1], r.pattern.columns[k]);
      }
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
