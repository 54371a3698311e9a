// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The law of a material, and lists of laws.
#include "solver/material/law.hpp"

#include "solver/material/law_list.hpp"
#include "solver/material/laws/linear_elastic.hpp"
#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

TEST(MaterialLaws, hold_what_every_law_must) { expect_laws_to_hold<MaterialLaws>(); }

TEST(MaterialLaws, are_numbered_in_the_order_of_the_list) {
  EXPECT_EQ(model_of<DruckerPrager>, MaterialModel::drucker_prager);
  EXPECT_EQ(model_of<Hencky>, MaterialModel::hencky);
  EXPECT_EQ(model_of<Corotated>, MaterialModel::corotated);
  EXPECT_EQ(model_of<LinearElastic>, MaterialModel::linear_elastic);
  EXPECT_EQ(model_of<NeoHookean>, MaterialModel::neo_hookean);
  EXPECT_EQ(model_of<MuOfI>, MaterialModel::mu_of_i);
  EXPECT_EQ(model_of<HerschelBulkley>, MaterialModel::herschel_bulkley);
}

TEST(MaterialLaws, load_gravity_elastically) {
  const Sym3<double> strain{-3, -3, -6, 1, 2, 3};
  for (const auto model : {MaterialModel::drucker_prager, MaterialModel::mu_of_i, MaterialModel::herschel_bulkley}) {
    EXPECT_EQ(model_while_loading(model), MaterialModel::hencky);
    EXPECT_EQ(trace(after_loading(model, strain)), 0);
  }
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::linear_elastic}) {
    EXPECT_EQ(model_while_loading(model), model);
    EXPECT_EQ(trace(after_loading(model, strain)), -12);
  }
}

TEST(Material, of_sand_alone_is_no_larger_than_elasticity_model_and_cone) {
  EXPECT_LE(sizeof(Material<double, LawList<DruckerPrager>>), 14 * sizeof(double));
  EXPECT_LE(sizeof(Material<float, LawList<DruckerPrager>>), 14 * sizeof(float));
  EXPECT_LE(sizeof(Material<double>), 30 * sizeof(double)) << "a kernel's arguments hold eight of them";
}

struct First {
  static constexpr std::string_view name = "first";
  static constexpr int number = 1;
};
struct Second {
  static constexpr std::string_view name = "second";
  static constexpr int number = 2;
};
using Both = LawList<First, Second>;

TEST(LawLists, know_the_place_of_each_law) {
  EXPECT_EQ(Both::count, 2);
  EXPECT_EQ(Both::index_of<First>(), 0);
  EXPECT_EQ(Both::index_of<Second>(), 1);
  EXPECT_EQ(Both::names(), (std::vector<std::string_view>{"first", "second"}));
}

TEST(LawLists, show_the_law_of_a_number_and_all_laws_in_order) {
  for (int index = 0; index < Both::count; ++index) {
    EXPECT_EQ(visit_law(Both{}, index, [](auto law) { return law.number; }), index + 1);
  }
  std::string all;
  Both::each([&](auto law) { all += law.name; });
  EXPECT_EQ(all, "firstsecond");
}

}  // namespace
}  // namespace talus::testing
