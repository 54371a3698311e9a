// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/vector_source.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

void expect_parts(const std::string& text, const VectorSource& parts) {
  const auto [file, layer, where] = vector_source(text);
  EXPECT_EQ(file, parts.file) << text;
  EXPECT_EQ(layer, parts.layer) << text;
  EXPECT_EQ(where, parts.where) << text;
  EXPECT_EQ(parts.text(), text);
}

TEST(VectorSource, layer_and_condition_may_be_left_out) {
  expect_parts("/a/b.gpkg", {.file = "/a/b.gpkg"});
  expect_parts("/a/b.gpkg|layername=c d", {.file = "/a/b.gpkg", .layer = "c d"});
  expect_parts("/a/b.gpkg|subset=id = 12", {.file = "/a/b.gpkg", .where = "id = 12"});
  expect_parts("/a/b.gpkg|layername=c|subset=id = 12", {.file = "/a/b.gpkg", .layer = "c", .where = "id = 12"});
  expect_parts("", {});
}

TEST(VectorSource, all_behind_the_mark_of_a_condition_belongs_to_it) {
  expect_parts("a.gpkg|subset=n = 'x/../|layername=y|subset=z'",
               {.file = "a.gpkg", .where = "n = 'x/../|layername=y|subset=z'"});
  expect_parts("a|b.gpkg", {.file = "a|b.gpkg"});
}

}  // namespace
}  // namespace talus
