// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges and obstacles of a run as JSON, and back.
#include "common/map/places.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(Places, come_back_to_a_centimetre) {
  const MapPlace gauge{"gauge bridge; south", {{{500050.126, 5000100}}}};
  const MapPlace wall{"obstacle \"wall\"", {{{0, 0}, {4, 0}, {4, 100.5}}, {{-1, -1}, {-2, -1}, {-1, -2}}}};
  const auto places = places_in(places_json({gauge, wall}));
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 2U);
  EXPECT_EQ(places->at(0).words, gauge.words);
  EXPECT_EQ(places->at(0).rings.at(0).at(0)[0], 500050.13);
  EXPECT_EQ(places->at(1), wall);
}

TEST(Places, that_are_none_are_refused) {
  const auto ring = [](const std::string& text) { return R"([{"words": "gauge a", "rings": [)" + text + "]}]"; };
  EXPECT_TRUE(places_in(ring("[[1, 2]]")));
  for (const std::string& text : {std::string(), std::string("{}"), std::string("[{}]"), ring("[]"), ring("[[1]]"),
                                  ring("[[1, null]]"), ring("[[1, \"2\"]]"), ring("[[1, 1e999]]"), ring("1")})
    EXPECT_FALSE(places_in(text)) << text;
}

}  // namespace
}  // namespace talus
