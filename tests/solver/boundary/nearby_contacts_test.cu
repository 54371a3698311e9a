// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels are run once for every contact point of the blocks in use, and for no other.
#include "solver/boundary/nearby_contacts.hpp"

#include "tests/solver/on_each_device.hpp"

namespace talus::solver::testing {
namespace {

/// One thread: one contact point. It counts that it was met.
struct CountVisits {
  int* visits;
  TALUS_HD void operator()(int c) const { ++visits[c]; }
};

/// Points in three of the 2 x 3 blocks of 8 x 12 columns, sorted by block: 0, 3 (two) and 4.
ContactPoints four_points() {
  ContactPoints points;
  points.cell[0] = {1, 4, 7, 0};
  points.cell[1] = {2, 4, 6, 11};
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

TEST_P(NearbyContactsOn, are_those_of_the_blocks_in_use) {
  in_both_orders([](const auto& device, bool in_order) {
    NearbyContacts contacts(device, four_points(), 8, 12, in_order);
    EXPECT_EQ(contacts.count(), 4);
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 0, 0, 0})) << "no block is in use yet";
    contacts.fit({1, 3, 4});
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{0, 1, 1, 1}));
    contacts.fit({0, 5});
    EXPECT_EQ(visits(device, contacts), (std::vector<int>{1, 0, 0, 0}));
  });
}

TALUS_IN_EACH_PLACE(NearbyContactsOn);

}  // namespace
}  // namespace talus::solver::testing
