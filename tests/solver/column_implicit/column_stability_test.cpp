// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How long a column-implicit step may be: the highest frequency of the linear scheme (T6a, T6b) in a dense mass and in
// a sheet of few points across, by Fourier analysis, and of a lone point. Quadratic splines, Poisson's ratio 0.25, and
// so a shear modulus of M' / 3.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace talus::solver::testing {
namespace {

constexpr double lame = 1.0 / 3, shear = 1.0 / 3, kappa = 0.3;  // of M' = 1

/// The ground under a mass, and its layers.
struct Ground {
  double slope_x, slope_y, layer;  ///< layer height over cell width

  /// Gradients on the map of those along the grid's lines, layers counted in cells.
  Eigen::Matrix3d to_map() const {
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    m(0, 2) = -slope_x;
    m(1, 2) = -slope_y;
    return m;
  }
  double steep() const { return 1 + slope_x * slope_x + slope_y * slope_y; }
  /// The springs' moduli: M' across the bed, the shear modulus along it, by 1 / h_z^2 and the slope (T6b).
  Eigen::Matrix3d springs() const {
    const Eigen::Vector3d normal = Eigen::Vector3d(-slope_x, -slope_y, 1) / std::sqrt(steep());
    const Eigen::Matrix3d across = normal * normal.transpose();
    return steep() / (layer * layer) * (across + shear * (Eigen::Matrix3d::Identity() - across));
  }
};

std::vector<Ground> grounds() {
  std::vector<Ground> all;
  for (const double layer : {1.0, 0.25, 1.0 / 16}) {
    for (const double degrees : {0.0, 30.0, 45.0, 60.0}) {
      const double slope = std::tan(degrees * M_PI / 180);
      all.push_back({slope, 0, layer});
      all.push_back({slope * M_SQRT1_2, slope * M_SQRT1_2, layer});
    }
  }
  return all;
}

/// The sums over neighbours of int N_0 N_j, int N_0' N_j' and int N_0 N_j' (over i) with exp(i j angle).
double mass_of(double angle) { return (66 + 52 * std::cos(angle) + 2 * std::cos(2 * angle)) / 120; }
double stiffness_of(double angle) { return 1 - 2.0 / 3 * std::cos(angle) - 1.0 / 3 * std::cos(2 * angle); }
double slope_of(double angle) { return (10 * std::sin(angle) + std::sin(2 * angle)) / 12; }

/// The largest of (omega dt)^2 of the wave with these angles from node to node, where waves cross `crossed` of a cell.
double square_of_wave(const Ground& ground, const Eigen::Vector3d& angle, double crossed) {
  const double h[3] = {1, 1, ground.layer};
  Eigen::Matrix3d products;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      double p = 1 / (h[a] * h[b]);
      for (int c = 0; c < 3; ++c) {
        const bool first = c == a, second = c == b;
        p *= first && second ? stiffness_of(angle[c]) : first || second ? slope_of(angle[c]) : mass_of(angle[c]);
      }
      products(a, b) = p;
    }
  }
  const Eigen::Matrix3d gradients = ground.to_map() * products * ground.to_map().transpose();
  const Eigen::Matrix3d stiffness =
      shear * gradients.trace() * Eigen::Matrix3d::Identity() + (lame + shear) * gradients;
  const Eigen::Matrix3d inertia =
      Eigen::Matrix3d::Identity() + kappa * crossed * crossed * 2 * (1 - std::cos(angle[2])) * ground.springs();
  return crossed * crossed *
         Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d>(stiffness, inertia, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .maxCoeff();
}

double highest_square(const Ground& ground, double cfl) {
  std::vector<double> along_layers{0};
  for (int n = 0; n < 14; ++n) along_layers.push_back(M_PI * std::pow(0.6, n));
  double highest = 0;
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      for (const double up : along_layers)
        highest = std::max(highest, square_of_wave(ground, {i * M_PI / 8, j * M_PI / 8, up}, cfl / M_SQRT2));
    }
  }
  return highest;
}

TEST(StepsByColumns, are_stable_in_a_dense_mass_beyond_the_longest_that_are_allowed) {
  for (const Ground& ground : grounds()) EXPECT_LT(highest_square(ground, 1.8), 4) << ground.layer;
  EXPECT_GT(highest_square({0, 0, 1}, 2.5), 4) << "on level ground from 2.3 on they are not";
}

/// A quadratic spline's weights on three nodes, or their slopes, of a point off the middle one.
std::array<double, 3> weights(double x) {
  return {0.5 * (0.5 - x) * (0.5 - x), 0.75 - x * x, 0.5 * (0.5 + x) * (0.5 + x)};
}
std::array<double, 3> slopes(double x) { return {x - 0.5, -2 * x, x + 0.5}; }

/// The elasticity for strains xx, yy, zz and twice xy, yz, zx.
Eigen::Matrix<double, 6, 6> elasticity() {
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(lame);
  for (int a = 0; a < 6; ++a) d(a, a) += a < 3 ? 2 * shear : shear;
  return d;
}

/// The function ties node n and the next one up by a spring; n counts the numbers of an inertia matrix.
void tie(Eigen::MatrixXd& inertia, int n, const Eigen::Matrix3d& spring) {
  inertia.block<3, 3>(n, n) += spring;
  inertia.block<3, 3>(n + 3, n + 3) += spring;
  inertia.block<3, 3>(n, n + 3) -= spring;
  inertia.block<3, 3>(n + 3, n) -= spring;
}

/// The strains of a point by the velocity of a node, whose weight has this gradient.
template <class Number>
Eigen::Matrix<Number, 6, 3> strains_by(const Eigen::Matrix<Number, 3, 1>& s) {
  Eigen::Matrix<Number, 6, 3> strains;
  strains << s.x(), 0, 0, 0, s.y(), 0, 0, 0, s.z(), s.y(), s.x(), 0, 0, s.z(), s.y(), s.z(), 0, s.x();
  return strains;
}

/// A lone point of mass 1: its strains by the velocities of its nodes, and inertia by columns.
struct LonePoint {
  Eigen::MatrixXd strains = Eigen::MatrixXd::Zero(6, 81), inertia = Eigen::MatrixXd::Zero(81, 81);

  LonePoint(const Ground& ground, const Eigen::Vector3d& place, double crossed) {
    const std::array<double, 3> w[] = {weights(place.x()), weights(place.y()), weights(place.z())},
                                g[] = {slopes(place.x()), slopes(place.y()), slopes(place.z())};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const int first = static_cast<int>(a * 3 + b) * 9;
        for (std::size_t c = 0; c < 3; ++c) {
          const Eigen::Vector3d s =
              ground.to_map() * Eigen::Vector3d(g[0][a] * w[1][b] * w[2][c], w[0][a] * g[1][b] * w[2][c],
                                                w[0][a] * w[1][b] * g[2][c] / ground.layer);
          const int n = first + 3 * static_cast<int>(c);
          strains.block<6, 3>(0, n) = strains_by<double>(s);
          inertia.block<3, 3>(n, n) += w[0][a] * w[1][b] * w[2][c] * Eigen::Matrix3d::Identity();
        }
        const double share = kappa * crossed * crossed * w[0][a] * w[1][b];
        tie(inertia, first, -g[2][0] * share * ground.springs());
        tie(inertia, first + 3, g[2][2] * share * ground.springs());
      }
    }
  }
  /// The largest of (omega dt)^2 over crossed^2.
  double square() const {
    const Eigen::Matrix<double, 6, 6> give = strains * inertia.ldlt().solve(strains.transpose()),
                                      root = elasticity().llt().matrixL();
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(root.transpose() * give * root,
                                                                      Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  }
};

/// A sheet without end, of two by two points a cell in plan and `across` through it, half a layer apart.
struct Sheet {
  const Ground& ground;
  int across;
  double bottom;  ///< above a node [layers]
  double crossed;

  int nodes() const { return static_cast<int>(std::lround(bottom + 0.5 * across)) + 3; }

  /// The node below a point and the point's place off the one in the middle of its three.
  static std::pair<int, double> at(double height) {
    const int middle = static_cast<int>(std::lround(height));
    return {middle - 1, height - middle};
  }
  double height(int n) const { return bottom + 0.5 * n + 1; }  // one node of the column is below the ground

  /// The inertia of a column, three by three numbers a node.
  Eigen::MatrixXd inertia() const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(3 * nodes(), 3 * nodes()) * 1e-12;
    const double share = kappa * crossed * crossed;
    for (int n = 0; n < across; ++n) {
      const auto [first, off] = at(height(n));
      const std::array<double, 3> w = weights(off), g = slopes(off);
      int node = 3 * first;
      for (const double weight : w) {
        m.block<3, 3>(node, node).diagonal().array() += weight;
        node += 3;
      }
      for (int c = 0; c < 2; ++c) {
        const Eigen::Matrix3d spring = (c == 0 ? -g[0] : g[2]) * share * ground.springs();
        tie(m, 3 * (first + c), spring);
      }
    }
    return m;
  }
  /// The strains of a cell's points by the velocities of a column, which its neighbours have too but for a phase.
  Eigen::MatrixXcd strains(double angle_x, double angle_y) const {
    using Complex = std::complex<double>;
    Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(24 * across, 3 * nodes());
    int row = 0;
    for (const double x : {-0.25, 0.25}) {
      for (const double y : {-0.25, 0.25}) {
        Complex sum_x = 0, sum_y = 0, slope_x = 0, slope_y = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const Complex px = std::polar(1.0, angle_x * static_cast<double>(a)),
                        py = std::polar(1.0, angle_y * static_cast<double>(a));
          sum_x += weights(x).at(a) * px, slope_x += slopes(x).at(a) * px;
          sum_y += weights(y).at(a) * py, slope_y += slopes(y).at(a) * py;
        }
        for (int n = 0; n < across; ++n, row += 6) {
          const auto [first, off] = at(height(n));
          for (std::size_t c = 0; c < 3; ++c) {
            const double w = weights(off).at(c), g = slopes(off).at(c) / ground.layer;
            const Eigen::Vector3cd s =
                ground.to_map() * Eigen::Vector3cd(slope_x * sum_y * w, sum_x * slope_y * w, sum_x * sum_y * g);
            all.block<6, 3>(row, 3 * (first + static_cast<int>(c))) = strains_by<Complex>(s);
          }
        }
      }
    }
    return all;
  }
  /// The largest of (omega dt)^2.
  double square() const {
    const Eigen::MatrixXd inertias = 4 * inertia();  // of four points at each height
    Eigen::MatrixXd moduli = Eigen::MatrixXd::Zero(24 * across, 24 * across);
    for (int n = 0; n < 4 * across; ++n) moduli.block<6, 6>(6 * n, 6 * n) = elasticity();
    double most = 0;
    for (int i = 0; i <= 4; ++i) {
      for (int j = -3; j <= 4; ++j) {
        const Eigen::MatrixXcd b = strains(i * M_PI / 4, j * M_PI / 4), stiffness = b.adjoint() * moduli * b;
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> modes(
            stiffness, inertias.cast<std::complex<double>>(), Eigen::EigenvaluesOnly);
        most = std::max(most, modes.eigenvalues().maxCoeff());
      }
    }
    return crossed * crossed * most;
  }
};

TEST(StepsByColumns, are_stable_in_sheets_of_half_a_layer_and_more) {
  for (const Ground& ground : grounds()) {
    for (const int across : {1, 2, 4, 8}) {
      for (const double bottom : {0.0, 0.3}) {
        EXPECT_LT((Sheet{ground, across, bottom, 1.8 / M_SQRT2}.square()), 4)
            << across << " points in layers of " << ground.layer << ", steepness " << ground.steep();
      }
    }
  }
  EXPECT_GT((Sheet{{0, 0, 1}, 2, 0.0, 2.5 / M_SQRT2}.square()), 4) << "on level ground from 2.4 on they are not";
}

TEST(StepsByColumns, swing_lone_points_no_faster_than_their_stress_is_forgotten_for) {
  // The square falls with the length of the step: springs are inertia. The one that matters is at its bound of 4.
  double largest = 0, steepest = 0;
  for (const Ground& ground : grounds()) {
    const bool steep_and_thin = ground.steep() > 3 && ground.layer < 0.2;  // 60 degrees, a sixteenth
    for (const double x : {-0.49, -0.2, 0.1, 0.49}) {
      for (const double y : {0.0, 0.3, 0.49}) {
        for (const double z : {-0.49, -0.1, 0.3}) {
          double crossed = 0.3;
          while (crossed < 0.75 && LonePoint(ground, {x, y, z}, crossed).square() * crossed * crossed < 4)
            crossed += 0.02;
          double& most = steep_and_thin ? steepest : largest;
          most = std::max(most, 4 / (crossed * crossed));
        }
      }
    }
  }
  EXPECT_LT(largest, 32) << "the bound that share_kept_alone() goes by";
  EXPECT_GT(largest, 25);
  EXPECT_LT(steepest, 37) << "0.47 CFL";
}

}  // namespace
}  // namespace talus::solver::testing
