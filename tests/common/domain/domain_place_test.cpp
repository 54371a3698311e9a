// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names and points of places as domain.vdb holds them.
#include "common/domain/domain_place.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

TEST(DomainPlace, names_of_files_become_names_of_columns) {
  for (const auto& [given, plain] : {std::pair{"gully-mouth", "gully-mouth"},
                                     {"Road 12 (north)", "Road-12-north"},
                                     {"  a  b ", "a-b"},
                                     {"Brücke", "Br-cke"},
                                     {"x", "x"},
                                     {"()", ""},
                                     {"", ""}}) {
    EXPECT_EQ(plain_name(given), plain) << given;
    EXPECT_EQ(is_plain_name(given), std::string(given) == plain && !std::string(given).empty()) << given;
  }
}

TEST(DomainPlace, points_come_back_to_the_last_bit) {
  const MapLine points{{683080.1, 5497450.0 / 3}, {-0.0, 1e-300}, {std::nextafter(1, 2), 12}};
  EXPECT_EQ(points_in(text_of_points(points)), points);
  EXPECT_EQ(text_of_points({{1, 2.5}, {3, 4}}), "1,2.5 3,4");
}

TEST(DomainPlace, texts_that_are_no_points_are_told) {
  for (const char* text : {"", " ", "1", "1,", "1,2 ", "1,2,3", "1;2", "1,2  3,4", "a,b", "nan,1", "1,inf", "1,2\n"})
    EXPECT_FALSE(points_in(text)) << text;
}

}  // namespace
}  // namespace talus
