// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The contacts of a step: what holds the nodes at its start, and the stiffness that friction adds.
#include "solver/implicit/contact_set.hpp"

#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

TEST(ContactSet, holds_the_nodes_on_the_bed_and_leaves_the_others_free) {
  SolveOptions o = options_of(Integrator::newmark);
  o.base.law = FrictionLaw::stick;
  PartsBench bench(o);
  const auto parts = bench.parts();
  NodeFields<CpuDevice> nodes(bench.device);
  nodes.resize(bench.grid.nodes());
  nodes.mass.upload(std::vector<double>(static_cast<std::size_t>(nodes.count), 2));
  double pull = 0;
  ContactSet<double, CpuDevice, PartsBench::Shape> contacts(
      parts, nodes, {bench.device, bench.settings.common.bed, bench.scene.bed}, &pull);
  EXPECT_TRUE(contacts.smoothing().smooths);
  contacts.resize();
  contacts.begin({.dynamic = true, .step = 0.01}, {}, {0, 0, -10});
  const auto freed = nodes.freed.download();
  const auto external = nodes.external.download();
  const auto slots = slots_of(bench.grid);
  const GridView<double> grid = bench.grid.view();
  int held = 0, free = 0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const BlockSlot& slot = slots[static_cast<std::size_t>((j >> 2) * grid.block_columns_x + (i >> 2))];
      for (int k = slot.first_layer; slot.offset >= 0 && k < slot.first_layer + slot.layers; ++k) {
        const auto n = static_cast<std::size_t>(GridView<double>::node(slot, i, j, k));
        EXPECT_EQ(trace(freed[n]), k == 0 ? 0 : 3) << "layer " << k;
        EXPECT_EQ(external[n].z, -20);
        (k == 0 ? held : free) += 1;
      }
    }
  }
  EXPECT_GT(held, 0);
  EXPECT_GT(free, 0);
  const Sym3<double>* stiffness = contacts.measure_stiffness();  // nothing slips, so that nothing is added
  for (int n = 0; n < nodes.count; ++n) EXPECT_EQ(trace(stiffness[n]), 0);
  EXPECT_GT(contacts.node_bytes(), 0u);
  EXPECT_EQ(contacts.point_bytes(), 0u) << "there are no surfaces between the nodes";
}

}  // namespace
}  // namespace talus::solver::testing
