// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every basal law must hold, whatever it is: checked over a list of laws.
#pragma once

#include <gtest/gtest.h>

#include <set>

#include "solver/boundary/column_traction.hpp"

namespace talus::testing {

/// A bed of this law with the defaults of all laws' options, dry, under 2000 kg/m3.
template <class Law, class Laws>
BaseFriction<double, Laws> some_bed(const OptionsOfLaws<Laws>& options = {}) {
  BaseFriction<double, Laws> f;
  f.law = static_cast<FrictionLaw>(Laws::template index_of<Law>());
  Law::numbers(options, {.borne = 1, .density = 2000, .gravity = 9.81}, f.uniform.numbers);
  Law::constants(options, {.borne = 1, .density = 2000, .gravity = 9.81}, f.constants);
  return f;
}

/// Friction, drag and yield are finite and take energy, whatever the speed and the column: also of one without weight.
template <class Law, class Laws>
void expect_finite_friction() {
  const auto f = some_bed<Law, Laws>();
  for (const double speed : {0.0, 1e-9, 0.1, 30.0}) {
    for (const double load : {0.0, 1e-6, 1.0, 1e5}) {
      const Slip<double> slip{speed, 9 * load, 0.01, load};
      const double mu = f.coefficient(f.uniform, slip), drag = f.drag(f.uniform, slip),
                   yield = f.yield(f.uniform, slip);
      EXPECT_TRUE(std::isfinite(mu) && mu >= 0 && mu < 10) << "speed " << speed << ", load " << load;
      EXPECT_TRUE(std::isfinite(drag) && drag >= 0) << "speed " << speed << ", load " << load;
      EXPECT_TRUE(std::isfinite(yield) && yield >= 0) << "speed " << speed << ", load " << load;
      EXPECT_TRUE(f.has_drag() || drag == 0);
      EXPECT_TRUE(f.has_traction() || yield == 0);
      EXPECT_TRUE(Law::rubs || mu == 0);
    }
  }
}

/// No step is so long and no column so light that the law's tractions would turn it back.
template <class Law, class Laws>
void expect_stable_steps() {
  const auto f = some_bed<Law, Laws>();
  for (const double step : {1e-6, 1e-2, 1e3}) {
    for (const double load : {1e-12, 1e-3, 1e4}) {
      for (const double speed : {1e-6, 1.0, 100.0}) {
        const Slip<double> slip{speed, 9 * load, step, load};
        const double left =
            share_left_by_traction(speed, f.drag(f.uniform, slip), f.yield(f.uniform, slip), step / load);
        EXPECT_TRUE(left >= 0 && left <= 1) << "step " << step << ", load " << load << ", speed " << speed;
      }
    }
  }
}

/// Every law of the list has a name, options whose keys it looks at, words and a finite friction.
template <class Laws>
void expect_laws_to_hold() {
  std::set<std::string> names, keys;
  Laws::each([&](auto law) {
    using Law = decltype(law);
    const ::testing::ScopedTrace trace(__FILE__, __LINE__, std::string(Law::name));
    EXPECT_TRUE(names.insert(std::string(Law::name)).second) << "two laws are called " << Law::name;
    typename Law::Options options;
    recipe::Defaults own;
    const LawTable table{.name = "[solve.base]", .chosen = Law::name};
    options.describe(*recipe::make_collector("law", own), table);
    for (const auto& [place, value] : own) {
      const std::string key = place.substr(place.rfind('.') + 1);
      EXPECT_TRUE(keys.insert(key).second) << key << " belongs to two laws";
      EXPECT_TRUE(Law::uses(key)) << key;
    }
    EXPECT_FALSE(Law::uses("no_such_key"));
    std::vector<Fault> faults;
    options.describe(*recipe::make_checker(faults), table);
    EXPECT_TRUE(faults.empty()) << "the defaults are refused";
    EXPECT_FALSE(Law::words(OptionsOfLaws<Laws>{}).empty());
    EXPECT_FALSE(Law::sentence(OptionsOfLaws<Laws>{}).empty());
    expect_finite_friction<Law, Laws>();
    expect_stable_steps<Law, Laws>();
    EXPECT_EQ((some_bed<Law, Laws>().holds()), Law::holds);
  });
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Laws::count));
}

}  // namespace talus::testing
