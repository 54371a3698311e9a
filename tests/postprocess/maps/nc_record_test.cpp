// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A NetCDF file that kept something else than it was given is told from one that kept all.
#include "postprocess/maps/nc_record.hpp"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <string>
#include <vector>

#include "postprocess/maps/nc_file.hpp"

namespace talus::postprocess {
namespace {

/// The content of a file: a map over time and texts, the second half of them in a group.
struct Content {
  std::vector<double> first = {1, -9999, std::nan(""), 4}, second = {5, 6, -0.0, 8};
  std::vector<std::string> names = {"a", "", "long name"};
  std::string unit = "m";
  std::vector<double> list = {0.1, 2};
  std::vector<int> whole = {-1, 7};

  std::string bytes() const {
    Nc nc("x.nc");
    const int time = nc.dimension("time", 2), y = nc.dimension("y", 2), x = nc.dimension("x", 2);
    const int map = nc.field("h", {time, y, x}, 2, 2);
    nc.text(map, "units", unit);
    nc.integers(map, "counts", whole);
    nc.enter_group("more");
    const int member = nc.dimension("member", 3);
    const int name = nc.variable("name", NC_STRING, {member});
    nc.numbers(NC_GLOBAL, "list", list);
    nc.end_definitions();
    nc.put_texts(name, names);
    nc.leave_group();
    nc.put_map(map, 0, 2, 2, first);
    nc.put_map(map, 1, 2, 2, second);
    return nc.close();  // it reads back what it was given
  }
  NcRecord record() const {
    NcRecord record;
    record.values({"", "h"}, {0, 0, 0}, {1, 2, 2}, first);
    record.values({"", "h"}, {1, 0, 0}, {1, 2, 2}, second);
    record.texts({"more", "name"}, names);
    record.text({"", "h"}, "units", unit);
    record.numbers({"", "h"}, "counts", {whole.begin(), whole.end()});
    record.numbers({"more", ""}, "list", list);
    return record;
  }
};

TEST(NcRecord, finds_no_difference_in_a_file_that_kept_all) {
  const Content content;
  EXPECT_EQ(content.record().difference(content.bytes()), "");
}

/// The difference of a file to the record of one with a change.
template <class Change>
std::string difference(const Change& change) {
  const Content kept;
  Content given;
  change(given);
  return given.record().difference(kept.bytes());
}

TEST(NcRecord, names_what_was_kept_otherwise) {
  EXPECT_EQ(difference([](Content& c) { c.second[2] = 0; }), "the values of h");
  EXPECT_EQ(difference([](Content& c) { c.names[1] = "b"; }), "the texts of name");
  EXPECT_EQ(difference([](Content& c) { c.unit = "km"; }), "units of h");
  EXPECT_EQ(difference([](Content& c) { c.whole.push_back(0); }), "counts of h");
  EXPECT_EQ(difference([](Content& c) { c.list[0] += 1e-16; }), "list of more");
}

TEST(NcRecord, knows_a_file_that_does_not_open) {
  const Content content;
  const std::string whole = content.bytes();
  EXPECT_EQ(content.record().difference(whole.substr(0, 100)), "it does not open");
}

}  // namespace
}  // namespace talus::postprocess
