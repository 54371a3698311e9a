// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What tests expect of vectors, of refusals and of the lists of points.
#pragma once

#include <gtest/gtest.h>

#include "common/error.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver::testing {

/// The components x, y and z of `a` are those of `b` but for a tolerance; `where` is said of those that are not.
template <class Vector, class Where = const char*>
void expect_near(const Vector& a, const Vec3<double>& b, double tolerance = 1e-12, const Where& where = "") {
  EXPECT_NEAR(a.x, b.x, tolerance) << where;
  EXPECT_NEAR(a.y, b.y, tolerance) << where;
  EXPECT_NEAR(a.z, b.z, tolerance) << where;
}

/// The faults of the error that `call` throws; none where it throws nothing.
template <class Kind, class Call>
std::vector<Fault> faults_of(Call&& call) {
  try {
    call();
  } catch (const Kind& error) {
    return error.faults();
  }
  return {};
}

/// The points with lists of what is the initial value everywhere, too.
inline ParticleState with_all_lists(ParticleState points) {
  visit_particle_fields(
      [&](const ParticleField& field, int, auto& list) {
        if (list.empty() && may_be_empty(field)) list.assign(points.size(), field.initial);
      },
      points);
  return points;
}

/// All that two lists of points hold is the same, bit for bit.
inline void expect_same_points(const ParticleState& a, const ParticleState& b) {
  const ParticleState all = with_all_lists(a), others = with_all_lists(b);
  visit_particle_fields(
      [&](const ParticleField& field, int component, const auto& list, const auto& other) {
        EXPECT_EQ(list, other) << field.name_of(component);
        EXPECT_EQ(list.size(), all.size()) << field.name_of(component);
      },
      all, others);
}

}  // namespace talus::solver::testing
