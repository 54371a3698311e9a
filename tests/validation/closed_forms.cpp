// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/closed_forms.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace talus::validation {
namespace {

/// Root of a growing function by bisection: as exact as doubles are, and never lost.
double root_of(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Gauss-Legendre, five points on [-1, 1].
constexpr double gauss_at[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
constexpr double gauss_weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                    0.2369268850561891};

/// A beam of length one, E = 1, width one. Either rigid against stretch and shear, or a section of fibres.
struct Section {
  double inertia, area, shear;  // shear: stiffness G A 5/6; infinite when rigid
  double depth;
  bool rigid;
  Law law;

  struct Forces {
    double normal, moment, normal_by_e, normal_by_c, moment_by_c;
  };

  /// Of the mean stretch e and the curvature c.
  Forces forces(double e, double c) const {
    Forces f{};
    constexpr int strips = 4;
    for (int s = 0; s < strips; ++s) {
      for (int g = 0; g < 5; ++g) {
        const double y = depth * ((s + 0.5 + 0.5 * gauss_at[g]) / strips - 0.5);
        const double w = 0.5 * gauss_weight[g] * depth / strips;
        const double l = 1 + e + c * y, n = piola_of_stretch(law, l);
        const double slope = law == Law::hencky ? (1 - std::log(l)) / (l * l) : 1;
        f.normal += w * n;
        f.moment += w * n * y;
        f.normal_by_e += w * slope;
        f.normal_by_c += w * slope * y;
        f.moment_by_c += w * slope * y * y;
      }
    }
    return f;
  }

  /// Mean stretch and curvature that carry a normal force and a moment.
  void solve(double normal, double moment, double& e, double& c) const {
    if (rigid) {
      e = 0;
      c = moment / inertia;
      return;
    }
    for (int i = 0; i < 50; ++i) {
      const Forces f = forces(e, c);
      const double rn = normal - f.normal, rm = moment - f.moment;
      const double det = f.normal_by_e * f.moment_by_c - f.normal_by_c * f.normal_by_c;
      const double de = (rn * f.moment_by_c - rm * f.normal_by_c) / det,
                   dc = (rm * f.normal_by_e - rn * f.normal_by_c) / det;
      e += de;
      c += dc;
      if (std::abs(de) + depth * std::abs(dc) < 1e-14) break;
    }
  }
};

struct BeamState {
  double x = 0, w = 0, angle = 0, moment = 0;
  BeamState after(const BeamState& rate, double h) const {
    return {x + h * rate.x, w + h * rate.w, angle + h * rate.angle, moment + h * rate.moment};
  }
};

/// Axis of the beam for a moment at the clamp; the state at the tip.
BeamState integrate(const Section& section, double load, double clamp_moment, AxisPoint* axis, int points) {
  constexpr int steps = 400;
  double e = 0, c = clamp_moment / section.inertia * 0.9;
  const auto rate = [&](const BeamState& s) {
    const double normal = load * std::sin(s.angle), across = load * std::cos(s.angle);
    section.solve(normal, s.moment, e, c);
    const double slip = section.rigid ? 0 : across / section.shear;
    BeamState r;
    r.x = (1 + e) * std::cos(s.angle) - slip * std::sin(s.angle);
    r.w = (1 + e) * std::sin(s.angle) + slip * std::cos(s.angle);
    r.angle = c;
    r.moment = -load * r.x;
    return r;
  };
  BeamState s;
  s.moment = clamp_moment;
  constexpr double h = 1.0 / steps;
  int put = 0;
  for (int n = 0; n <= steps; ++n) {
    while (put < points && put * steps <= n * (points - 1)) axis[put++] = {s.x, s.w};
    if (n == steps) break;
    const BeamState a = rate(s), b = rate(s.after(a, h / 2)), d = rate(s.after(b, h / 2)), f = rate(s.after(d, h));
    s = s.after(a, h / 6).after(b, h / 3).after(d, h / 3).after(f, h / 6);
  }
  return s;
}

Tip beam(const Section& section, double k, AxisPoint* axis, int points) {
  const double load = k * section.inertia;
  // The moment at the tip grows with that at the clamp, which no lever longer than the beam can exceed by much.
  const double moment =
      root_of([&](double m) { return integrate(section, load, m, nullptr, 0).moment; }, 0, 1.1 * load);
  const BeamState tip = integrate(section, load, moment, axis, points);
  return {tip.w, 1 - tip.x};
}

}  // namespace

double piola_of_stretch(Law law, double stretch) {
  return law == Law::hencky ? std::log(stretch) / stretch : stretch - 1;
}

double stretch_of_piola(Law law, double piola) {
  if (law == Law::corotated) return 1 + piola;
  return root_of([&](double l) { return piola_of_stretch(law, l) - piola; }, 1e-6, std::exp(1.0));
}

double piola_of_kirchhoff(Law law, double kirchhoff) {
  if (law == Law::hencky) return kirchhoff / std::exp(kirchhoff);
  return 0.5 * (std::sqrt(1 + 4 * kirchhoff) - 1);  // stretch (stretch - 1), the branch near 1
}

double Column::settlement(double x) const {
  constexpr int strips = 64;
  double sum = 0;
  for (int s = 0; s < strips; ++s) {
    for (int g = 0; g < 5; ++g) {
      const double at = x * (s + 0.5 + 0.5 * gauss_at[g]) / strips;
      sum += 0.5 * gauss_weight[g] * x / strips * (1 - stretch_of_piola(law, piola(at) / modulus));
    }
  }
  return sum;
}

Tip elastica(double k) { return beam({1, 1, 1, 0, true, Law::corotated}, k, nullptr, 0); }

Tip solid_beam(double k, double depth, Law law, AxisPoint* axis, int points) {
  const double shear = 5.0 / 6 * 0.5 * depth;  // G = E / 2
  return beam({depth * depth * depth / 12, depth, shear, depth, false, law}, k, axis, points);
}

double SlidingBlock::acceleration(double speed) const {
  const double mu = steady + (peak - steady) / (1 + speed / characteristic);
  return gravity * (std::sin(angle) - mu * std::cos(angle));
}

double SlidingBlock::way(double speed, double time) const {
  constexpr int steps = 100000;  // midpoint rule
  const double dt = time / steps;
  double way = 0;
  for (int n = 0; n < steps; ++n) {
    const double middle = speed + 0.5 * dt * acceleration(speed);
    way += dt * middle;
    speed += dt * acceleration(middle);
  }
  return way;
}

double GroundLine::elevation(double x) const {
  if (kind == parabola) {
    const double left = std::max(run - x, 0.0) / run;
    return fall * left * left;
  }
  const double slope = std::numbers::pi / 6,
               foot = fall / std::tan(slope);        // where the straight slope would meet level ground
  const double half = radius * std::tan(slope / 2);  // the arc's reach beyond it, and before it along the slope
  if (x >= foot + half) return 0;
  if (x <= foot - half * std::cos(slope)) return (foot - x) * std::tan(slope);
  const double from_end = foot + half - x;
  return radius - std::sqrt(radius * radius - from_end * from_end);
}

double GroundLine::reach(double x, double mu) const {
  constexpr double g = 9.81, dx = 0.05;
  const auto slope_at = [&](double at) { return std::atan((elevation(at - dx) - elevation(at + dx)) / (2 * dx)); };
  double square = 0, angle = slope_at(x);  // of the speed
  for (int step = 0; step < 1000000; ++step) {
    const double next = slope_at(x + dx), mean = 0.5 * (angle + next), ds = dx / std::cos(mean);
    const double turn = angle - next;
    const double change = 2 * g * (std::sin(mean) - mu * std::cos(mean)) * ds - 2 * mu * square * turn;
    if (square + change <= 0) return change < 0 && square > 0 ? x + dx * square / -change : x;
    square += change;
    angle = next;
    x += dx;
  }
  return std::numeric_limits<double>::infinity();
}

ParabolicCap::State ParabolicCap::at(double time) const {
  const double pull = gravity * (std::sin(slope) - std::cos(slope) * std::tan(bed)),
               size = 2 * gravity * std::cos(slope) * depth / (radius * radius);
  // f'^2 = size (1 - 1 / f^2), so that f^2 = 1 + size t^2.
  const double width = std::sqrt(1 + size * time * time);
  return {0.5 * pull * time * time, pull * time, width, size * time / width};
}

double ParabolicCap::thickness(const State& s, double along, double across) const {
  const double r = std::hypot(along - s.way, across) / (radius * s.width);
  return r < 1 ? depth * (1 - r * r) / (s.width * s.width) : 0;
}

namespace {

/// Of the dam break: speed of small waves, and the acceleration of all.
double wave_of(const DamBreak& d) { return std::sqrt(d.gravity * d.depth * std::cos(d.slope)); }
double pull_of(const DamBreak& d) { return d.gravity * (std::sin(d.slope) - std::cos(d.slope) * std::tan(d.bed)); }

}  // namespace

double DamBreak::thickness(double x, double time) const {
  const double c = wave_of(*this), fallen = x - 0.5 * pull_of(*this) * time * time;
  if (fallen <= -c * time) return depth;
  if (fallen >= 2 * c * time) return 0;
  const double root = 2 * c - fallen / time;
  return root * root / (9 * gravity * std::cos(slope));
}

double DamBreak::speed(double x, double time) const {
  const double c = wave_of(*this), pull = pull_of(*this), fallen = x - 0.5 * pull * time * time;
  if (fallen <= -c * time) return pull * time;
  if (fallen >= 2 * c * time) return 0;
  return 2.0 / 3.0 * (fallen / time + c) + pull * time;
}

double observed_order(const double* x, const double* y, int count) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int i = 0; i < count; ++i) {
    const double lx = std::log(x[i]), ly = std::log(y[i]);
    sx += lx;
    sy += ly;
    sxx += lx * lx;
    sxy += lx * ly;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

double lube_run_out(double a) {
  if (a < 1.8) return 1.6 * a;
  return a > 2.8 ? 2.2 * std::pow(a, 2.0 / 3) : std::numeric_limits<double>::quiet_NaN();
}

double lube_height(double a) { return a < 1.15 ? a : std::pow(a, 0.4); }

double lajeunesse_run_out(double a) { return a < 2.3 ? 1.2 * a : 1.9 * std::pow(a, 2.0 / 3); }

double lajeunesse_height(double a) { return a < 0.7 ? a : std::cbrt(a); }

double round_run_out(double a) { return a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a); }

double round_height(double a) {
  if (a < 1) return a;
  return a > 1.7 ? 0.88 * std::pow(a, 1.0 / 6) : std::numeric_limits<double>::quiet_NaN();
}

Band band_of(double one, double other) {
  return {0.9 * std::fmin(one, other), 1.1 * std::fmax(one, other)};  // fmin and fmax leave out a NaN
}

}  // namespace talus::validation
