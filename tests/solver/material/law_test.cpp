// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The list of constitutive laws: what holds for every one of them.
#include "solver/material/law.hpp"

#include <gtest/gtest.h>

#include "solver/material/laws/corotated.hpp"
#include "solver/material/laws/drucker_prager.hpp"
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

}  // namespace
}  // namespace talus::testing
