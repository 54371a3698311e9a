// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of basal laws: what holds for every one of them, and the numbers that rasters give.
#include "solver/boundary/law.hpp"

#include "common/domain/bed_numbers.hpp"
#include "solver/options/bed.hpp"
#include "tests/solver/boundary/any_law.hpp"

namespace talus::testing {
namespace {

using solver::BaseOptions;

TEST(FrictionLaws, hold_what_every_law_must) { expect_laws_to_hold<FrictionLaws>(); }

TEST(FrictionLaws, weaken_or_drag_as_their_numbers_say) {
  OptionsOfLaws<FrictionLaws> o;
  o.turbulence = 1000;
  const auto voellmy = some_bed<Voellmy, FrictionLaws>(o);
  EXPECT_DOUBLE_EQ(voellmy.coefficient(voellmy.uniform, {5, 0, 0.01}), std::tan(20 * std::numbers::pi / 180));
  EXPECT_DOUBLE_EQ(voellmy.drag(voellmy.uniform, {5, 0, 0.01}), 2000 * 9.81 / 1000 * 25);
  const auto weakening = some_bed<VelocityWeakening, FrictionLaws>(o);
  EXPECT_DOUBLE_EQ(weakening.coefficient(weakening.uniform, {1, 0, 0.01}), (0.7 + 0.23) / 2);
}

TEST(Bed, is_no_larger_than_its_five_numbers_were) { EXPECT_LE(sizeof(Bed<double>), 5 * sizeof(double)); }

TEST(BedNumbers, are_those_of_the_laws_and_have_a_member_each) {
  BaseOptions options;
  std::set<double*> members;
  for (const std::string_view key : bed_numbers) {
    double* const number = options.named(key);
    ASSERT_NE(number, nullptr) << key;
    EXPECT_TRUE(members.insert(number).second) << key;
    bool used = false;
    FrictionLaws::each([&](auto law) {
      options.law = static_cast<FrictionLaw>(FrictionLaws::index_of<decltype(law)>());
      used = used || options.uses(key);
    });
    EXPECT_TRUE(used) << key << " belongs to no law";
  }
  EXPECT_EQ(options.named("law"), nullptr);
}

/// The numbers of a law, those of a place and of the scene.
template <class Law>
struct Made {
  std::vector<double> here = std::vector<double>(Law::count), everywhere = std::vector<double>(Law::constant_count);
  explicit Made(const BaseOptions& o) {
    const BedSetting setting{.borne = 1, .density = 2000, .gravity = 9.81};
    Law::numbers(o, setting, here.data());
    Law::constants(o, setting, everywhere.data());
  }
};

TEST(BedNumbers, reach_the_numbers_of_a_place_and_no_others_do) {
  // A number of the scene that a raster gives would be missed in silence, and so would one of a place that none gives.
  FrictionLaws::each([&](auto law) {
    using Law = decltype(law);
    typename Law::Options own;
    recipe::Defaults keys;
    own.describe(*recipe::make_collector("law", keys), {});
    for (const auto& [place, value] : keys) {
      const std::string key = place.substr(place.rfind('.') + 1);
      const bool from_raster = std::find(bed_numbers.begin(), bed_numbers.end(), key) != bed_numbers.end();
      BaseOptions options;
      const Made<Law> before(options);
      if constexpr (std::is_same_v<Law, FrictionTable>) {
        options.table.back()[0] *= 0.9;
      } else {
        double* const number = options.named(key);
        ASSERT_NE(number, nullptr) << key;
        *number = 0.9 * *number + 0.01;
      }
      const Made<Law> after(options);
      EXPECT_EQ(before.here != after.here, from_raster) << key;
      EXPECT_EQ(before.everywhere != after.everywhere, !from_raster) << key;
    }
  });
}

TEST(BaseOptions, say_the_bed_in_a_line) {
  BaseOptions o;
  o.cohesion = 50;
  EXPECT_EQ(o.words(), "coulomb, 20 deg, cohesion 50 Pa");
  o.law = FrictionLaw::voellmy;
  o.pore_pressure_ratio = 0.5;
  EXPECT_EQ(o.words(), "voellmy, 20 deg and xi = 500 m/s2, cohesion 50 Pa, water carries 0.5 of the normal stress");
  o.law = FrictionLaw::stick;
  EXPECT_EQ(o.words(), "held");
}

}  // namespace
}  // namespace talus::testing
