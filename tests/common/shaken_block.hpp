// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid block on an inclined plane whose ground shakes, integrated finely (Newmark 1965), and records to shake it
// with. Nothing here knows the solver.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace talus::test {

/// The acceleration of the ground in the plane of the fall, linear between samples, none before and after.
struct GroundRecord {
  std::vector<double> time;      ///< [s]
  std::vector<double> east, up;  ///< [m/s2]

  /// The method adds a sample.
  void add(double t, double a, double b = 0) {
    time.push_back(t);
    east.push_back(a);
    up.push_back(b);
  }
};

/// A plane that falls to the east, with Coulomb friction.
struct ShakenPlane {
  double angle, friction;  ///< [deg]
  static constexpr double g = 9.81;

  static double radians(double degrees) { return degrees * std::numbers::pi / 180; }
  double coefficient() const { return std::tan(radians(friction)); }
  /// The horizontal acceleration of the ground, over g, from which the block slides down.
  double yield() const { return std::tan(radians(friction - angle)); }
  /// What the block gains along its plane on every m/s2 above that.
  double gain() const { return std::cos(radians(angle)) + coefficient() * std::sin(radians(angle)); }

  /// The way of a rigid block down the plane until `end` [m], in steps of 1e-5 s, each with the ground's acceleration
  /// in its middle.
  double way(const GroundRecord& ground, double end) const {
    constexpr double step = 1e-5;
    const double sine = std::sin(radians(angle)), cosine = std::cos(radians(angle));
    double speed = 0, way = 0;
    std::size_t next = 0;
    for (int n = 0; (n + 0.5) * step < end; ++n) {
      const double t = (n + 0.5) * step;
      while (next < ground.time.size() && ground.time[next] <= t) ++next;
      double east = 0, up = -g;  // the pull in the frame of the ground
      if (next > 0 && next < ground.time.size()) {
        const double share = (t - ground.time[next - 1]) / (ground.time[next] - ground.time[next - 1]);
        east -= ground.east[next - 1] + share * (ground.east[next] - ground.east[next - 1]);
        up -= ground.up[next - 1] + share * (ground.up[next] - ground.up[next - 1]);
      }
      const double hold = coefficient() * std::fmax(-(east * sine + up * cosine), 0.0) * step;
      const double free = speed + (east * cosine - up * sine) * step;  // without friction
      const double after = std::abs(free) <= hold ? 0 : free - std::copysign(hold, free);
      way += 0.5 * (speed + after) * step;
      speed = after;
    }
    return way;
  }

  /// The way under a pulse of `strength` [m/s2] that lasts `length` [s], by Newmark's closed form [m].
  double way_of_pulse(double strength, double length) const {
    const double rate = gain() * g, speed = strength / g * rate * length;
    return speed * speed / (2 * rate * yield()) * (1 - yield() * g / strength);
  }
  /// How long after the beginning of that pulse the block rests again [s].
  double time_of_pulse(double strength, double length) const { return length * strength / g / yield(); }
};

/// A pulse towards the west, so that the block slides to the east: `strength` [m/s2] from `begin` to `end` [s].
inline GroundRecord pulse(double strength, double begin, double end) {
  constexpr double edge = 1e-6;
  GroundRecord record;
  record.add(begin, 0);
  record.add(begin + edge, -strength);
  record.add(end, -strength);
  record.add(end + edge, 0);
  return record;
}

/// Waves of this strength [m/s2] and frequency [1/s] from `begin` on, sampled every hundredth of a second.
inline GroundRecord sine_train(double strength, double frequency, int cycles, double begin) {
  GroundRecord record;
  const int count = static_cast<int>(std::lround(100 * cycles / frequency));
  for (int n = 0; n <= count; ++n)
    record.add(begin + 0.01 * n, strength * std::sin(2 * std::numbers::pi * frequency * 0.01 * n));
  return record;
}

/// Forty waves of 0.5 to 5 Hz, horizontal ones and half as strong ones upwards, their frequencies and phases by a fixed
/// seed, under an envelope: `duration` [s] from `begin` on, sampled every hundredth of a second, `strength` [m/s2] at
/// most.
inline GroundRecord irregular(double strength, double duration, double begin, unsigned seed) {
  std::mt19937 chance(seed);  // whose numbers, unlike those of distributions, are the same everywhere
  const auto share = [&] { return static_cast<double>(chance()) / 4294967296.0; };
  struct Wave {
    double frequency, phase, phase_up;
  };
  std::vector<Wave> waves(40);
  for (Wave& w : waves) {
    w.frequency = 2 * std::numbers::pi * (0.5 + 4.5 * share());
    w.phase = 2 * std::numbers::pi * share();
    w.phase_up = 2 * std::numbers::pi * share();
  }
  GroundRecord record;
  double largest = 0;
  const int count = static_cast<int>(std::lround(100 * duration));
  for (int n = 0; n <= count; ++n) {
    const double t = 0.01 * n, envelope = std::pow(std::sin(std::numbers::pi * t / duration), 2);
    double east = 0, up = 0;
    for (const Wave& w : waves) {
      east += envelope * std::sin(w.frequency * t + w.phase);
      up += 0.5 * envelope * std::sin(w.frequency * t + w.phase_up);
    }
    record.add(begin + t, east, up);
    largest = std::fmax(largest, std::hypot(east, up));
  }
  for (std::size_t n = 0; n < record.time.size(); ++n) {
    record.east[n] *= strength / largest;
    record.up[n] *= strength / largest;
  }
  return record;
}

}  // namespace talus::test
