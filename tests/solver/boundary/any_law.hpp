// What every basal law must hold, whatever it is: checked over a list of laws.
#pragma once

#include <gtest/gtest.h>

#include <set>

#include "solver/boundary/base_friction.hpp"

namespace talus::testing {

/// A bed of this law with the defaults of all laws' options, dry, under 2000 kg/m3.
template <class Law, class Laws>
BaseFriction<double, Laws> some_bed(const OptionsOfLaws<Laws>& options = {}) {
  BaseFriction<double, Laws> f;
  f.law = static_cast<FrictionLaw>(Laws::template index_of<Law>());
  Law::numbers(options, {.borne = 1, .density = 2000, .gravity = 9.81}, f.uniform.numbers);
  return f;
}

template <class Law, class Laws>
void expect_finite_friction() {
  const auto f = some_bed<Law, Laws>();
  for (const double speed : {0.0, 0.1, 30.0}) {
    const Slip<double> slip{speed, 1e4, 0.01};
    const double mu = f.coefficient(f.uniform, slip), drag = f.drag(f.uniform, slip);
    EXPECT_TRUE(std::isfinite(mu) && mu >= 0 && mu < 10) << "speed " << speed;
    EXPECT_TRUE(std::isfinite(drag) && drag >= 0) << "speed " << speed;
    if (!f.has_drag()) {
      EXPECT_EQ(drag, 0);
    }
    if (!Law::rubs) {
      EXPECT_EQ(mu, 0);
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
    EXPECT_EQ((some_bed<Law, Laws>().holds()), Law::holds);
  });
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Laws::count));
}

}  // namespace talus::testing
