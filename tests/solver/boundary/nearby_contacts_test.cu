// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels are run once for every contact point of the blocks in use and of those around them, and for no other.
#include "solver/boundary/surface_contact.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// One thread: one contact point. It counts that it was met.
struct CountVisits {
  int* visits;
  TALUS_HD void operator()(int c) const { ++visits[c]; }
};

/// Points in three of the 4 x 5 blocks of 14 x 20 columns, sorted by block: 0, 11 (two) and 17.
ContactPoints four_points() {
  ContactPoints points;
  points.cell[0] = {1, 12, 13, 7};
  points.cell[1] = {2, 8, 11, 16};
  points.cell[2] = {0, 0, 5, 2};
  points.body = {0, 0, 0, 0};
  return points;
}

class NearbyContactsOn : public OnEachDevice {
 protected:
  template <class Body>
  void in_both_orders(Body&& body) {
    for (const bool in_order : {false, true}) on_device([&](const auto& device) { body(device, in_order); });
  }
};

template <class Device>
std::vector<int> visits(const Device& device, const NearbyContacts<Device>& contacts) {
  Buffer<int, Device> counts(device, 4);
  counts.fill_zero();
  contacts.each(CountVisits{counts.data()});
  return counts.download();
}

TEST_P(NearbyContactsOn, are_those_of_the_blocks_in_use_and_around_them) {
  in_both_orders([](const auto& device, bool in_order) {
    NearbyContacts contacts(device, four_points(), 14, 20, in_order);
    EXPECT_EQ(contacts.count(), 4);
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 0, 0, 0})) << "no block is in use yet";
    contacts.fit({0});
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{1, 0, 0, 0}));
    contacts.fit({11, 17});
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 1, 1, 1}));
    contacts.fit({5});  // beside 0
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{1, 0, 0, 0}));
    contacts.fit({8});  // at the other edge of the row of 11
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 0, 0, 0}));
    contacts.fit({14, 18});  // each beside 11, or beside 17
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 1, 1, 1}));
  });
}

TALUS_IN_EACH_PLACE(NearbyContactsOn);

}  // namespace
}  // namespace talus::solver::testing
