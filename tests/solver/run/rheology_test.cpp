// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs on an incline whose stress depends on the rate of shear: speeds and angles of the closed forms.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double gravity_size = 9.81;

/// A slab 1 m thick along the vertical and one cell of 2 m wide, between smooth side walls, under its own weight: long
/// enough that its ends do not reach its middle.
struct HeldSlab {
  static constexpr double cell = 2, upright = 1, from = 8, to = 56;
  double slope;  ///< [deg]
  int layers;
  SolveOptions options;

  HeldSlab(double slope_angle, MaterialModel model, double density, int layer_count = 8)
      : slope(slope_angle), layers(layer_count) {
    options.material.model = model;
    options.material.density = density;
    options.material.youngs_modulus = 3e6;
    options.base.law = FrictionLaw::stick;
    options.walls = {{Axis::y, 4, Side::above}, {Axis::y, 6, Side::below}};
  }
  /// Thickness along the normal [m].
  double thickness() const { return upright * std::cos(slope * degree); }
  /// Shear stress on the base [Pa].
  double base_shear() const { return options.material.density * gravity_size * thickness() * std::sin(slope * degree); }
  /// The slab under the pressure of its weight: what is left to come is the shear.
  Scene scene() const {
    const double fall = std::tan(slope * degree);
    Domain d = ground(48, 6, cell, upright / layers, [&](double x, double) { return 200 - fall * x; });
    d.grid.west = d.grid.south = -cell / 2;  // nodes at the walls
    fill(d, {from, to, 4, 6, 0, upright});
    Scene s = make_scene(d, options);
    const double bulk = make_material<double>(options.material).bulk_modulus, cosine = std::cos(slope * degree);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      const double above = upright - d.points.height[static_cast<std::size_t>(s.points.id[p])];
      s.points.log_volume[p] = -options.material.density * gravity_size * above * cosine * cosine / bulk;
    }
    return s;
  }

  /// Speeds along the slope within 4 m of the slab's middle, to 2 %: their mean, that of the topmost points, and the
  /// root mean square over the points from profile(height along the normal) over its largest speed [m/s].
  void expect_flow(On on, double time, double mean, const std::function<double(double)>& profile) const {
    const Scene s = scene();
    const auto solver = make_solver(s, options, on);
    run_to(*solver, time);
    const ParticleState points = solver->state().points;
    const auto x = positions(s, points);
    const double cosine = std::cos(slope * degree), sine = std::sin(slope * degree), layer = upright / layers;
    const double middle = centre(*solver, s).x;
    double sum = 0, volume = 0, top = 0, highest = 0, squares = 0, count = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (std::abs(x[p][0] - middle) > 4) continue;
      const double speed = points.velocity[0][p] * cosine - points.velocity[2][p] * sine;
      const double height = (points.cell[2][p] + points.offset[2][p]) * layer * cosine;
      sum += points.volume[p] * speed;
      volume += points.volume[p];
      squares += std::pow(speed - profile(height), 2);
      ++count;
      if (height > (upright - 0.6 * layer) * cosine) {
        top += speed;
        ++highest;
      }
    }
    const double surface = profile(thickness());
    EXPECT_NEAR(sum / volume / mean, 1, 0.02);
    EXPECT_NEAR(top / highest / surface, 1, 0.02);
    EXPECT_LT(std::sqrt(squares / count) / surface, 0.02);
  }
};

class FlowOnIncline : public InEachPlace {};
TALUS_IN_EACH_PLACE(FlowOnIncline);

/// Bagnold's profile: mu(I) = tan(slope) asks for the same I at every height, so that with p = rho g cos(slope) (H - z)
/// the rate of shear is (I / d) sqrt(rho g cos(slope) (H - z) / rho_s), and its integral
///   u = (2 / 3) (I / d) sqrt(rho g cos(slope) / rho_s) (H^1.5 - (H - z)^1.5), of mean 3/5 of the surface's.
TEST_P(FlowOnIncline, of_mu_of_i_has_bagnolds_profile) {
  HeldSlab slab(26, MaterialModel::mu_of_i, 1500);
  MaterialOptions& m = slab.options.material;
  m.grain_diameter = 0.3;
  const double friction = std::tan(slab.slope * degree), slow = m.internal_friction(),
               fast = std::tan(m.limiting_friction_angle * degree);
  // rise I^2 + (fast - friction) I - (friction - slow) I_0 = 0
  const double half = 0.5 * (fast - friction) / m.fast_friction_rise;
  const double number = std::sqrt(half * half + (friction - slow) * m.inertial_number / m.fast_friction_rise) - half;
  const double depth = slab.thickness();
  const double scale = 2.0 / 3 * number / m.grain_diameter *
                       std::sqrt(m.density * gravity_size * std::cos(slab.slope * degree) / m.grain_density);
  const auto bagnold = [&](double z) {
    return scale * (std::pow(depth, 1.5) - std::pow(std::max(depth - z, 0.0), 1.5));
  };
  slab.expect_flow(GetParam(), 4.5, 0.6 * bagnold(depth), bagnold);
}

/// Herschel-Bulkley: tau = rho g sin(slope) (H - z) = tau_y + k (du/dz)^n below z_s = H - tau_y / (rho g sin(slope)),
/// and a plug above: with m = (n + 1) / n
///   u = (rho g sin(slope) / k)^(1/n) / m (z_s^m - (z_s - z)^m).
TEST_P(FlowOnIncline, of_mud_has_the_profile_of_herschel_and_bulkley) {
  for (const double exponent : {0.5, 1.0}) {
    SCOPED_TRACE(exponent);
    HeldSlab slab(15, MaterialModel::herschel_bulkley, 1800);
    MaterialOptions& mud = slab.options.material;
    mud.yield_stress = 1500;
    mud.flow_exponent = exponent;
    mud.consistency = exponent == 1 ? 1500 : 2500;
    const double depth = slab.thickness(), weight = slab.base_shear() / depth;
    const double sheared = depth - mud.yield_stress / weight, power = (exponent + 1) / exponent;
    const auto profile = [&](double z) {
      return std::pow(weight / mud.consistency, 1 / exponent) / power *
             (std::pow(sheared, power) - std::pow(std::max(sheared - z, 0.0), power));
    };
    // Its mean: the plug, and power / (power + 1) of its speed over what is sheared.
    const double mean = profile(depth) * (1 - sheared / depth / (power + 1));
    slab.expect_flow(GetParam(), 2.5, mean, profile);
  }
}

/// How far a slab's middle goes along x from one to two seconds after it was let go with this speed [m]. Later its toe,
/// which nothing holds, would have reached it: the slab stretches from there.
double way_of_middle(HeldSlab& slab, double speed, On on) {
  const double angle = slab.slope * degree;
  slab.options.initial_velocity = {speed * std::cos(angle), 0, -speed * std::sin(angle)};
  const Scene scene = slab.scene();
  const auto solver = make_solver(scene, slab.options, on);
  const auto middle = [&] {
    const ParticleState s = solver->state().points;
    const auto x = positions(scene, s);
    double sum = 0, count = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      if (std::abs(x[p][0] - 0.5 * (HeldSlab::from + HeldSlab::to)) > 4) continue;
      sum += s.velocity[0][p];
      ++count;
    }
    return sum / count;
  };
  run_to(*solver, 1);
  double way = 0, before = middle();
  for (int n = 1; n <= 20; ++n) {
    run_to(*solver, 1 + 0.05 * n);
    const double now = middle();
    way += 0.025 * (before + now);
    before = now;
  }
  return way;
}

TEST_P(FlowOnIncline, of_mud_is_none_below_the_yield_stress) {
  for (const double share : {0.95, 1.25}) {
    HeldSlab slab(15, MaterialModel::herschel_bulkley, 1800);
    slab.options.material.yield_stress = slab.base_shear() / share;
    slab.options.material.consistency = 900;
    const double way = way_of_middle(slab, 0, GetParam());
    if (share < 1) {
      EXPECT_LT(std::abs(way), 0.005);
    } else {
      EXPECT_GT(way, 0.02);
    }
  }
}

/// Half a degree below the static angle a slab rests, and comes to rest; half a degree above it flows.
TEST_P(FlowOnIncline, of_mu_of_i_starts_and_stops_at_the_static_angle) {
  for (const double angle : {20.4, 21.4}) {
    for (const double speed : {0.0, 0.2}) {
      HeldSlab slab(angle, MaterialModel::mu_of_i, 1500);
      slab.options.material.grain_diameter = 0.15;
      const double way = way_of_middle(slab, speed, GetParam());
      if (angle < 20.9) {
        EXPECT_LT(std::abs(way), 0.005);
      } else {
        EXPECT_GT(way, 0.05);
      }
    }
  }
}

/// Dense grains hold until the slope's tangent is mu_s + K (phi - phi_s), loose ones give way below mu_s: those of 0.62
/// at 24.8 degrees, those of 0.59 at 18.9, between which lies the angle of this slope and that of steady flow, 20.9.
TEST_P(FlowOnIncline, of_dense_grains_starts_at_a_steeper_angle) {
  const auto way = [&](double angle, double fraction) {
    HeldSlab slab(angle, MaterialModel::mu_of_i, 1500);
    slab.options.material.grain_diameter = 0.15;
    slab.options.material.volume_fraction = fraction;
    return way_of_middle(slab, 0, GetParam());
  };
  EXPECT_LT(std::abs(way(22.5, 0.62)), 0.005);
  const double steady = way(22.5, 0.60), loose = way(22.5, 0.59);
  EXPECT_GT(steady, 0.1);
  EXPECT_GT(loose, steady);
  // Above its angle the dense slab starts too, and behind the loose one.
  const double dense = way(26, 0.62);
  EXPECT_GT(dense, 0.1);
  EXPECT_GT(way(26, 0.59), 1.1 * dense);
  EXPECT_LT(std::abs(way(20, 0.60)), 0.005);
}

/// A slab that flows grows by what its grains dilate: the height of its surface is the integral of phi_0 / phi over the
/// thickness, and phi tends to phi_eq(I) of mu(I) = tan(slope), I = 0.179.
TEST_P(FlowOnIncline, of_grains_rises_as_they_dilate) {
  for (const auto& [fraction, precision] : {std::pair{0.62, Precision::double_}, std::pair{0.56, Precision::single_}}) {
    HeldSlab slab(26, MaterialModel::mu_of_i, 1500);
    slab.options.precision = precision;
    slab.options.material.grain_diameter = 0.3;
    slab.options.material.volume_fraction = fraction;
    const Scene scene = slab.scene();
    const auto solver = make_solver(scene, slab.options, GetParam());
    const double layer = HeldSlab::upright / slab.layers, row_height = 0.5 * layer;  // two rows of points a layer
    const auto height_of = [&](const ParticleState& s, std::size_t p) {
      return (s.cell[2][p] + s.offset[2][p]) * layer;
    };
    const ParticleState first = solver->state().points;
    std::vector<std::size_t> row_of(first.size());
    for (std::size_t p = 0; p < first.size(); ++p)
      row_of[static_cast<std::size_t>(first.id[p])] = static_cast<std::size_t>(height_of(first, p) / row_height);
    run_to(*solver, 4.5);
    const ParticleState points = solver->state().points;
    const auto x = positions(scene, points);
    const double middle = centre(*solver, scene).x;
    const auto rows = static_cast<std::size_t>(2 * slab.layers);
    std::vector<double> volume(rows), count(rows), height(rows);
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (std::abs(x[p][0] - middle) > 4) continue;
      const std::size_t row = row_of[static_cast<std::size_t>(points.id[p])];
      volume[row] += std::exp(points.plastic_log_volume[p]);
      height[row] += height_of(points, p);
      ++count[row];
    }
    double grown = 0;  // up to the middle of the topmost row
    for (std::size_t row = 0; row < rows; ++row)
      grown += (row + 1 == rows ? 0.5 : 1) * row_height * volume[row] / count[row];
    const double top = height.back() / count.back(), before = HeldSlab::upright - 0.5 * row_height;
    const double at_base = fraction * count[1] / volume[1];
    // A fortieth of a layer: rows are no longer level, and the weight strains the slab by 2 mm at first.
    EXPECT_NEAR(top, grown, 0.003);
    // phi_eq is 0.564. The dense slab starts late and is on its way there.
    if (fraction < 0.6) {
      EXPECT_NEAR(at_base, 0.6 - 0.2 * 0.179, 0.001);
    } else {
      EXPECT_GT(top - before, 0.04);
      EXPECT_LT(at_base, 0.59);
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
