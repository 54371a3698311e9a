// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Constitutive laws against plain references: eigenvalue forms by Eigen, finite differences of the energy, the cone.
#include "solver/material/material.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "solver/material/laws/drucker_prager.hpp"
#include "solver/material/state.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

using Matrix = Eigen::Matrix3d;

Matrix to_eigen(const Sym3<double>& s) {
  Matrix m;
  m << s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz;
  return m;
}

Sym3<double> from_eigen(const Matrix& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)}; }

Mat3<double> columns(const Matrix& m) {
  return {{m(0, 0), m(1, 0), m(2, 0)}, {m(0, 1), m(1, 1), m(2, 1)}, {m(0, 2), m(1, 2), m(2, 2)}};
}

/// f of a symmetric matrix through its eigenvalues.
template <class F>
Matrix spectral(const Matrix& m, F f) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().unaryExpr(f).asDiagonal() * solver.eigenvectors().transpose();
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  Matrix matrix(double size) {
    Matrix m;
    for (int i = 0; i < 9; ++i) m.data()[i] = size * uniform_(engine_);
    return m;
  }
  Matrix symmetric(double size) {
    const Matrix m = matrix(size);
    return 0.5 * (m + m.transpose());
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// Drucker and Prager's law on one of its cones.
Material<double> on_cone(Cone cone, double friction, double dilatancy = 0, double cohesion = 0, double cutoff = 0) {
  MaterialOptions o;
  o.model = MaterialModel::drucker_prager;
  o.cone = cone;
  o.friction_angle = friction;
  o.dilatancy_angle = dilatancy;
  o.cohesion = cohesion;
  o.tension_cutoff = cutoff;
  return make_material<double>(o);
}

/// Under the same pressure from all sides, compressed along each axis by a strain.
MaterialState<double> compressed(const Material<double>& m, double strain) {
  MaterialState<double> s;
  advance_material(m, columns(Matrix(-strain * Matrix::Identity())), 0.01, s);
  return s;
}

Material<double> sand(double dilatancy = 0, double cohesion = 0, double cutoff = 0) {
  MaterialOptions o;
  o.youngs_modulus = 1e7;
  o.poisson_ratio = 0.3;
  o.friction_angle = 30;
  o.dilatancy_angle = dilatancy;
  o.cohesion = cohesion;
  o.tension_cutoff = cutoff;
  return make_material<double>(o);
}

TEST(HenckyStrain, agrees_with_the_matrix_logarithm_for_small_and_large_strain) {
  Random random(1);
  for (const double size : {1e-7, 1e-4, 4e-3, 9e-3, 0.02, 0.03, 0.3}) {
    for (int n = 0; n < 50; ++n) {
      const Matrix strain = random.symmetric(size), g = random.matrix(size);
      const Matrix b = spectral(strain, [](double e) { return std::exp(2 * e); });
      const Matrix f = Matrix::Identity() + g;
      const Matrix trial = f * b * f.transpose();
      const Matrix expected = spectral(0.5 * (trial + trial.transpose()), [](double l) { return 0.5 * std::log(l); });
      const Matrix got = to_eigen(advance_strain(from_eigen(strain), columns(g)));
      // Series: relative 3e-11 at the size where they hand over; the reference itself loses 1e-16.
      EXPECT_LT((got - expected).norm(), 1e-10 * size + 2e-15) << "strain size " << size;
    }
  }
}

TEST(HenckyStrain, knows_the_volume_change) {
  Random random(2);
  for (const double size : {1e-8, 1e-3, 0.2}) {
    const Matrix g = random.matrix(size);
    const double expected = std::log((Matrix::Identity() + g).determinant());
    EXPECT_NEAR(log_volume_change(columns(g)), expected, 1e-15 + 1e-9 * size * size);
  }
}

TEST(Pieces, turn_no_matter_inside_out) {
  Random random(7);
  int inside_out = 0;
  for (const double size : {0.04, 0.3, 1.0, 3.0}) {
    for (int n = 0; n < 500; ++n) {
      const Matrix g = random.matrix(size);
      const int pieces = pieces_of(columns(g));
      EXPECT_LE(g.cwiseAbs().sum(), 0.5 * pieces) << "the size of a piece";
      EXPECT_TRUE(pieces == 1 || g.cwiseAbs().sum() > 0.25 * pieces) << "no more pieces than it takes";
      inside_out += (Matrix::Identity() + g).determinant() <= 0 ? 1 : 0;
      MaterialState<double> state{};
      state = advance_in_pieces(sand(), columns(g), pieces, 0.01, state);
      const double piece = (Matrix::Identity() + g / pieces).determinant();
      EXPECT_NEAR(state.log_volume, pieces * std::log(piece), 1e-12 * pieces);
      EXPECT_TRUE(std::isfinite(norm_squared(state.elastic))) << "size " << size;
    }
  }
  EXPECT_GT(inside_out, 200) << "that in one piece would have been";
}

TEST(EigenSymmetric, finds_values_and_directions) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    Matrix m = random.symmetric(1);
    if (n % 3 == 0) m = Matrix::Identity() * 2 + 1e-9 * m;  // nearly equal
    double values[3];
    Mat3<double> vectors;
    eigen_symmetric(from_eigen(m), values, vectors);
    EXPECT_LT((to_eigen(compose(values, vectors)) - m).norm(), 1e-14 * m.norm());
  }
}

TEST(Hencky, has_the_stress_that_its_energy_asks_for) {
  Material<double> m = sand();
  m.model = MaterialModel::hencky;
  Random random(4);
  const Matrix strain = random.symmetric(0.01), direction = random.symmetric(1);
  const auto energy = [&](double t) {
    MaterialState<double> s;
    s.elastic = from_eigen(strain + t * direction);
    return elastic_energy(m, s);
  };
  MaterialState<double> s;
  s.elastic = from_eigen(strain);
  const double slope = (energy(1e-6) - energy(-1e-6)) / 2e-6;
  const double work = (to_eigen(kirchhoff_stress(m, s)).cwiseProduct(direction)).sum();
  EXPECT_NEAR(slope / work, 1, 1e-8);
}

TEST(Hencky, does_not_feel_a_rotation) {
  Material<double> m = sand();
  m.model = MaterialModel::hencky;
  Random random(5);
  MaterialState<double> s;
  s.elastic = from_eigen(random.symmetric(0.05));
  const Matrix before = to_eigen(kirchhoff_stress(m, s));
  const Matrix turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  advance_material(m, columns(turn - Matrix::Identity()), 0.01, s);
  EXPECT_LT((to_eigen(kirchhoff_stress(m, s)) - turn * before * turn.transpose()).norm(), 1e-10 * before.norm());
  EXPECT_NEAR(s.log_volume, 0, 1e-14);
}

TEST(LinearElastic, follows_hookes_law_and_turns_with_the_body) {
  Material<double> m = sand();
  m.model = MaterialModel::linear_elastic;
  MaterialState<double> s;
  Matrix g = Matrix::Zero();
  g(2, 2) = -1e-5;
  advance_material(m, columns(g), 0.01, s);
  const double oedometric = m.bulk_modulus + 4 * m.shear_modulus / 3;
  EXPECT_NEAR(s.elastic.zz, -1e-5 * oedometric, 1e-9 * oedometric);
  // A quarter turn about x in small steps carries zz to yy; the Jaumann rate errs by the square of the step.
  constexpr int steps = 20000;
  Matrix spin = Matrix::Zero();
  spin(1, 2) = -std::numbers::pi / 2 / steps;
  spin(2, 1) = -spin(1, 2);
  const double carried = s.elastic.zz, side = s.elastic.yy;
  for (int n = 0; n < steps; ++n) advance_material(m, columns(spin), 0.01, s);
  EXPECT_NEAR(s.elastic.yy / carried, 1, 1e-3);
  EXPECT_NEAR(s.elastic.zz / side, 1, 1e-3);
}

double shear_measure(const Sym3<double>& tau) { return std::sqrt(0.5 * norm_squared(deviator(tau))); }
double pressure_of(const Sym3<double>& tau) { return -trace(tau) / 3; }

TEST(DruckerPrager, ends_on_or_inside_the_cone) {
  for (const double cohesion : {0.0, 1e4}) {
    for (const double dilatancy : {0.0, 10.0}) {
      const auto m = sand(dilatancy, cohesion, 5e3);
      Random random(6);
      for (int n = 0; n < 500; ++n) {
        MaterialState<double> s;
        for (int k = 0; k < 5; ++k) advance_material(m, columns(random.matrix(2e-3)), 0.01, s);
        const auto tau = kirchhoff_stress(m, s);
        const double p = pressure_of(tau);
        EXPECT_LE(shear_measure(tau), m.friction * p + m.shear_cohesion + 1e-6);
        EXPECT_GE(p, -m.tension - 1e-6);
      }
    }
  }
}

TEST(DruckerPrager, meets_mohr_coulomb_in_triaxial_compression) {
  const auto m = on_cone(Cone::compression, 31);
  MaterialState<double> s = compressed(m, 1e-3);
  Matrix g = Matrix::Zero();
  g(2, 2) = -1e-4;
  g(0, 0) = g(1, 1) = 0.5e-4;
  for (int n = 0; n < 200; ++n) advance_material(m, columns(g), 0.01, s);
  const auto tau = kirchhoff_stress(m, s);
  const double sine = std::sin(31 * std::numbers::pi / 180);
  EXPECT_NEAR(tau.zz / tau.xx, (1 + sine) / (1 - sine), 1e-3);
}

TEST(DruckerPrager, meets_mohr_coulomb_in_plane_strain_for_its_own_flow) {
  // Sheared in a plane, nothing across it: for any dilatancy the circle in the plane touches the line of 31 degrees.
  const double sine = std::sin(31 * std::numbers::pi / 180), cohesion = 2e3;
  for (const double dilatancy : {0.0, 1.0, 15.0, 31.0}) {
    const auto m = on_cone(Cone::plane_strain, 31, dilatancy, cohesion, 1e6);  // its cohesion bears tension
    MaterialState<double> s = compressed(m, 1e-3);
    Matrix g = Matrix::Zero();
    g(2, 2) = -1e-5;
    g(0, 0) = 1e-5;
    const double start = pressure_of(kirchhoff_stress(m, s));
    for (int n = 0; n < 4000; ++n) {  // it may widen in the plane, so that the pressure stays
      advance_material(m, columns(g), 0.01, s);
      g(0, 0) = 1e-5 + (pressure_of(kirchhoff_stress(m, s)) - start) / m.bulk_modulus;
    }
    const auto tau = kirchhoff_stress(m, s);
    const double radius = 0.5 * (tau.xx - tau.zz), mean = -0.5 * (tau.xx + tau.zz);
    EXPECT_NEAR(radius / (mean * sine + cohesion * std::sqrt(1 - sine * sine)), 1, 2e-3) << "dilatancy " << dilatancy;
  }
}

TEST(DruckerPrager, meets_mohr_coulomb_on_the_plane_that_slips) {
  // Simple shear between plates that dilate as the flow does: shear over normal stress on the plate is that of the line
  // of 31 degrees whatever the dilatancy is.
  const double slope = std::tan(31 * std::numbers::pi / 180), cohesion = 2e3;
  for (const double dilatancy : {0.0, 1.0, 15.0, 31.0}) {
    const auto m = on_cone(Cone::simple_shear, 31, dilatancy, cohesion, 1e6);
    MaterialState<double> s = compressed(m, 1e-4);
    Matrix g = Matrix::Zero();
    g(0, 2) = 1e-6;
    const double start = pressure_of(kirchhoff_stress(m, s));
    for (int n = 0; n < 4000; ++n) {  // the plates give way, so that the pressure stays
      advance_material(m, columns(g), 0.01, s);
      g(2, 2) = 1e-6 * std::tan(dilatancy * std::numbers::pi / 180) +
                (pressure_of(kirchhoff_stress(m, s)) - start) / m.bulk_modulus;
    }
    const auto tau = kirchhoff_stress(m, s);
    EXPECT_NEAR(tau.xz / (-tau.zz * slope + cohesion), 1, 2e-3) << "dilatancy " << dilatancy;
  }
}

TEST(DruckerPrager, carries_no_tension_however_steep_its_cone) {
  // Pulled along one axis at constant volume, the worst that a cone can meet: the stress along it may vanish, not turn.
  for (const auto cone : {Cone::simple_shear, Cone::compression, Cone::extension, Cone::plane_strain}) {
    for (const double angle : {30.0, 40.0, 60.0, 85.0}) {
      const auto m = on_cone(cone, angle);
      MaterialState<double> s = compressed(m, 1e-4);
      Matrix g = Matrix::Zero();
      g(2, 2) = 1e-5;
      g(0, 0) = g(1, 1) = -0.5e-5;
      for (int n = 0; n < 200; ++n) advance_material(m, columns(g), 0.01, s);
      const auto tau = kirchhoff_stress(m, s);
      EXPECT_LE(tau.zz, 1e-6 * pressure_of(tau)) << angle;
    }
  }
}

TEST(DruckerPrager, opened_grain_must_close_before_it_carries_load) {
  const auto m = sand();
  MaterialState<double> s;
  const Matrix open = 0.01 * Matrix::Identity(), close = -0.006 * Matrix::Identity();
  advance_material(m, columns(open), 0.01, s);
  EXPECT_EQ(pressure_of(kirchhoff_stress(m, s)), 0);
  advance_material(m, columns(close), 0.01, s);
  EXPECT_EQ(pressure_of(kirchhoff_stress(m, s)), 0) << "still open by 0.4 %";
  EXPECT_EQ(shear_measure(kirchhoff_stress(m, s)), 0);
  advance_material(m, columns(close), 0.01, s);
  EXPECT_GT(pressure_of(kirchhoff_stress(m, s)), 0);
}

TEST(Materials, that_hold_tension_are_the_elastic_ones_and_sand_with_a_tension_cut_off) {
  MaterialOptions o;
  const auto holds = [&](MaterialModel model) {
    o.model = model;
    const bool asked = o.holds_tension();
    EXPECT_EQ(make_material<double>(o).holds_tension(), asked);
    return asked;
  };
  for (const MaterialModel model :
       {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::linear_elastic, MaterialModel::neo_hookean})
    EXPECT_TRUE(holds(model));
  for (const MaterialModel model :
       {MaterialModel::drucker_prager, MaterialModel::mu_of_i, MaterialModel::herschel_bulkley})
    EXPECT_FALSE(holds(model));
  o.cohesion = 1e4;
  EXPECT_FALSE(holds(MaterialModel::drucker_prager)) << "cohesion alone carries no mean tension";
  o.tension_cutoff = 1e3;
  EXPECT_TRUE(holds(MaterialModel::drucker_prager));
}

TEST(Materials, go_to_the_first_compiled_set_that_holds_their_laws) {
  Materials<double> all;
  const auto laws = [&] {
    int count = 0;
    with_laws_of(all, [&]<class Laws>(const Materials<double, Laws>&) { count = Laws::count; });
    return count;
  };
  for (Material<double>& m : all.list) m.model = model_of<DruckerPrager>;
  EXPECT_EQ(laws(), 1);
  all.list[1].model = model_of<Hencky>;
  EXPECT_EQ(laws(), MaterialLaws::count);
}

TEST(Materials, keep_laws_and_numbers_in_a_set_of_some_laws) {
  Materials<double> all;
  for (Material<double>& m : all.list) m.model = model_of<DruckerPrager>;
  all.list[1].model = model_of<Hencky>;
  all.list[1].density = 1500;
  all.list[0].numbers_of<DruckerPrager>().tension = 7;
  using Two = LawList<Hencky, DruckerPrager>;
  ASSERT_TRUE(all.all_in(Two{}));
  EXPECT_FALSE(all.all_in(LawList<DruckerPrager>{}));
  const Materials<double, Two> some = all.only(Two{});
  EXPECT_EQ(some.list[1].model, (model_of<Hencky, Two>));
  EXPECT_EQ(some.list[1].density, 1500);
  EXPECT_EQ(some.list[0].model, (model_of<DruckerPrager, Two>));
  EXPECT_EQ(some.list[0].numbers_of<DruckerPrager>().tension, 7);
}

/// A lone point opens by the same rate for ever: its gradient is that of its own affine velocity.
TEST(DruckerPrager, lone_grain_that_opens_for_ever_keeps_a_state) {
  const auto material = sand();
  MaterialState<double> state;
  Mat3<double> opens;
  opens.a.x = opens.b.y = 0.02;
  for (int step = 0; step < 100000; ++step) advance_material(material, opens, 1e-3, state);
  EXPECT_EQ(state.log_volume, widest_opening);
  EXPECT_EQ(kirchhoff_stress(material, state).xx, 0);
  opens.a.x = opens.b.y = -0.02;
  for (int step = 0; step < 300; ++step) advance_material(material, opens, 1e-3, state);
  EXPECT_LT(kirchhoff_stress(material, state).xx, 0) << "it closes again";
}

TEST(DruckerPrager, dilates_as_it_shears_only_when_asked) {
  Matrix shear = Matrix::Zero();
  shear(0, 1) = 1e-4;
  for (const double dilatancy : {0.0, 5.0}) {
    const auto m = sand(dilatancy);
    MaterialState<double> s = compressed(m, 1e-3);
    const double before = pressure_of(kirchhoff_stress(m, s));
    for (int n = 0; n < 100; ++n) advance_material(m, columns(shear), 0.01, s);  // at constant volume
    const double after = pressure_of(kirchhoff_stress(m, s));
    if (dilatancy > 0) {
      EXPECT_GT(after, 1.05 * before);
      EXPECT_GT(s.plastic_log_volume, 0);
    } else {
      EXPECT_NEAR(after / before, 1, 1e-4);
      EXPECT_EQ(s.plastic_log_volume, 0);
    }
  }
}

TEST(DruckerPrager, keeps_small_stress_in_single_precision) {
  MaterialOptions o;
  o.youngs_modulus = 8e9;  // strains of 1e-5
  const auto exact = make_material<double>(o);
  const auto coarse = make_material<float>(o);
  MaterialState<double> a;
  MaterialState<float> b;
  Random random(8);
  for (int n = 0; n < 1000; ++n) {
    const Matrix g = random.matrix(1e-7) - 2e-8 * Matrix::Identity();
    advance_material(exact, columns(g), 0.01, a);
    const auto c = columns(g);
    const auto to_float = [](const Vec3<double>& v) {
      return Vec3<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    advance_material(coarse, Mat3<float>{to_float(c.a), to_float(c.b), to_float(c.c)}, 0.01f, b);
  }
  const auto tau = kirchhoff_stress(exact, a);
  const auto single = kirchhoff_stress(coarse, b);
  // A thousand roundings of 6e-8 of the strain itself, not of 1.
  EXPECT_NEAR(static_cast<double>(single.xx) / tau.xx, 1, 1e-4);
  EXPECT_NEAR(static_cast<double>(single.zz) / tau.zz, 1, 1e-4);
}

}  // namespace
}  // namespace talus::solver
