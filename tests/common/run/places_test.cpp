// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges and obstacles as facts of a run, and back.
#include "common/run/places.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"

namespace talus {
namespace {

TEST(Places, come_back_to_a_centimetre) {
  const MapPlace gauge{"gauge bridge; south", {{{500050.126, 5000100}}}};
  const MapPlace wall{"obstacle wall", {{{0, 0}, {4, 0}, {4, 100.5}}, {{-1, -1}, {-2, -1}, {-1, -2}}}};
  const auto places = places_in({place_fact(gauge), {"run.id", "1,2"}, place_fact(wall)});
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0].words, "gauge bridge; south");
  EXPECT_NEAR(places[0].rings.at(0).at(0)[0], 500050.13, 1e-9);
  EXPECT_EQ(places[1].rings, wall.rings);
}

TEST(Places, of_many_corners_fit_into_an_attribute) {
  MapPlace shore{"obstacle shore", {{}}};
  for (int i = 0; i < 20000; ++i) shore.rings[0].push_back({500000.0 + i, 5000000.0 + i % 7});
  const auto fact = place_fact(shore);
  EXPECT_LE(fact.second.size(), 30000U);
  const auto ring = places_in({fact}).at(0).rings.at(0);
  EXPECT_GT(ring.size(), 500U);
  EXPECT_GT(ring.back()[0], 519900) << "its far end is there";
  MapPlace town{"obstacle town", {}};
  for (int i = 0; i < 5000; ++i) town.rings.push_back({{1e5 + i, 0}, {1e5 + i, 1}, {1e5 + i + 1, 1}, {1e5 + i + 1, 0}});
  EXPECT_GT(places_in({place_fact(town)}).at(0).rings.size(), 300U);
}

TEST(Places, that_are_none_are_refused) {
  for (const char* text : {"", "1", "1,", "1,2 ", "1,2;", "1;2", "nan,1", "1,inf", "1,2x", ",1"})
    EXPECT_THROW(places_in({{"place.gauge a", text}}), DataError) << text;
}

}  // namespace
}  // namespace talus
