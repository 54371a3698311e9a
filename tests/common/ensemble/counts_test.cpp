// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::holds;

namespace fs = std::filesystem;

void expect_same_counts(const EnsembleCounts& a, const EnsembleCounts& b) {
  using C = EnsembleCounts;
  test::expect_same(a, b, &C::fingerprint, &C::members, &C::part, &C::states, &C::flow, &C::deposit, &C::release,
                    &C::failures, &C::findings);
  test::expect_same_maps(a, b);
  for (std::size_t k = 0; k < a.results.size(); ++k)
    for (const ResultNumber& number : result_numbers) {
      const double ours = a.results[k].*(number.value), theirs = b.results[k].*(number.value);
      EXPECT_TRUE(ours == theirs || (std::isnan(ours) && std::isnan(theirs))) << number.name << " of member " << k;
    }
  ASSERT_EQ(a.at_gauges().size(), b.at_gauges().size());
  for (const auto& [name, values] : a.at_gauges()) EXPECT_TRUE(b.at_gauges().contains(name)) << name;
  for (std::size_t k = 0; k < a.results.size(); ++k)
    for (const auto& [name, ours] : a.results[k].at_gauges) {
      const double theirs = b.results[k].at_gauges.at(name);
      EXPECT_TRUE(ours == theirs || (std::isnan(ours) && std::isnan(theirs))) << name << " of member " << k;
    }
}

const std::vector<fs::path> three_files{"counts.0-9.h5", "counts.9-20.h5", "counts.20-30.h5"};

TEST(EnsembleCounts, of_parts_give_the_bits_of_the_whole_in_any_order) {
  const MemberTable table = test::ensemble_table(30);
  const EnsembleCounts whole = test::part_of_ensemble(table, {0, 30}, 8);
  std::vector<std::size_t> order{0, 1, 2};
  const MemberRange ranges[] = {{0, 9}, {9, 20}, {20, 30}};
  do {
    std::vector<EnsembleCounts> parts;
    for (const std::size_t n : order) parts.push_back(test::part_of_ensemble(table, ranges[n], 8));
    expect_same_counts(merged(std::move(parts), three_files), whole);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(EnsembleCounts, name_a_member_that_failed_and_leave_it_out) {
  const MemberTable table = test::ensemble_table(10);
  const EnsembleCounts counts = test::part_of_ensemble(table, {0, 10}, 5);
  EXPECT_EQ(counts.count(MemberState::failed), 2);
  EXPECT_EQ(counts.count(MemberState::counted), 8);
  ASSERT_EQ(counts.failures.size(), 2u);
  EXPECT_EQ(counts.failures[0].member, 4);
  EXPECT_EQ(counts.maps[0].reached[counts.cells.find(3, 7)], 8u);
}

TEST(EnsembleCounts, of_missing_parts_leave_members_waiting_and_of_another_ensemble_or_a_member_twice_are_refused) {
  const MemberTable table = test::ensemble_table(30);
  std::vector<EnsembleCounts> parts{test::part_of_ensemble(table, {9, 20})};
  const EnsembleCounts all = merged(parts, three_files);
  EXPECT_EQ(all.count(MemberState::waiting), 19);
  EXPECT_EQ(all.part, (MemberRange{0, 30}));
  parts = {test::part_of_ensemble(table, {0, 9}), test::part_of_ensemble(table, {8, 20})};
  auto fault = test::fault_of<DataError>([&] { merged(parts, three_files); });
  EXPECT_TRUE(holds(fault, {"counts.9-20.h5: member 8 is counted in another file as well"}));
  parts[1] = test::part_of_ensemble(table, {9, 20});
  parts[1].fingerprint = "another";
  fault = test::fault_of<DataError>([&] { merged(parts, three_files); });
  EXPECT_TRUE(holds(fault, {"counts.9-20.h5: counts of another ensemble than counts.0-9.h5"}));
}

TEST(EnsembleCounts, of_one_fingerprint_but_other_maps_are_refused) {
  const MemberTable table = test::ensemble_table(30);
  const auto fault_of_second = [&](const std::function<void(EnsembleCounts&)>& change) {
    std::vector<EnsembleCounts> parts;
    parts.push_back(test::part_of_ensemble(table, {0, 9}));
    parts.push_back(test::part_of_ensemble(table, {9, 20}));
    change(parts[1]);
    return test::fault_of<DataError>([&] { merged(std::move(parts), three_files); });
  };
  EXPECT_TRUE(holds(fault_of_second([](EnsembleCounts& part) { part.members = 40; }), {"counts.9-20.h5"}));
  EXPECT_TRUE(holds(fault_of_second([](EnsembleCounts& part) { part.scene.grid.west += 5; }), {"counts.9-20.h5"}));
  EXPECT_TRUE(
      holds(fault_of_second([](EnsembleCounts& part) { part.maps[0].thresholds.back() = 77; }), {"counts.9-20.h5"}));
}

using CountsFile = test::InScratch;

TEST_F(CountsFile, comes_back_as_it_was_written) {
  const MemberTable table = test::ensemble_table(12);
  EnsembleCounts counts = test::part_of_ensemble(table, {3, 12}, 4);
  counts.provenance = {{"recipe.solve", "aabb"}, {"note", "two\nlines"}};
  write_counts(scratch / "counts.3-12.h5", counts);
  const EnsembleCounts read = read_counts(scratch / "counts.3-12.h5");
  expect_same_counts(read, counts);
  EXPECT_EQ(read.provenance, counts.provenance);
  ASSERT_EQ(read.at_gauges().size(), 1u);
  EXPECT_TRUE(read.at_gauges().contains("gauge_bridge_arrival_s"));
  EXPECT_EQ(read.scene.grid.west, counts.scene.grid.west);
  test::expect_same(read.scene, counts.scene, &EnsembleScene::title, &EnsembleScene::release_thickness);
}

TEST_F(CountsFile, keeps_deposits_of_members_where_that_is_asked_for) {
  constexpr double quantum = 1e-3;
  const MemberTable table = test::ensemble_table(12);
  const auto part = [&](const MemberRange& range, bool keeps) {
    EnsembleCounts counts = empty_counts(test::ensemble_scene(), 12, range, {});
    counts.fingerprint = "f";
    counts.deposit_quantum = keeps ? quantum : 0;
    for (std::int64_t k = range.first; k < range.end; ++k)
      if (k == 4)
        counts.fail(k, "too fast");
      else
        counts.add(k, test::member_maps(counts.scene, test::reach_of(table, k), test::depth_of(table, k)), {});
    write_counts(scratch / "counts.h5", counts);
    return read_counts(scratch / "counts.h5");
  };
  const EnsembleCounts all = merged({part({6, 12}, false), part({0, 6}, true)}, {"b", "a"});
  const std::size_t cells = all.scene.grid.count();
  for (const std::int64_t k : {0, 1, 2, 3, 5}) {
    SCOPED_TRACE(k);
    const KeptThickness& kept = all.deposit_thickness[static_cast<std::size_t>(k)];
    ASSERT_TRUE(kept.kept());
    const RunMaps maps = test::member_maps(all.scene, test::reach_of(table, k), test::depth_of(table, k));
    const std::vector<double> thickness = kept.thickness(cells);
    double most = 0;
    for (std::size_t c = 0; c < cells; ++c) {
      EXPECT_NEAR(thickness[c], maps.deposit_thickness[c], 0.5001 * quantum);
      most = std::max(most, thickness[c]);
    }
    EXPECT_GT(most, 0.1);
  }
  EXPECT_FALSE(all.deposit_thickness[4].kept()) << "failed";
  EXPECT_FALSE(all.deposit_thickness[7].kept()) << "of a part that keeps none";
  EXPECT_EQ(keep_thickness(std::vector<double>(9, 0.0), quantum).thickness(9), std::vector<double>(9, 0.0));
}

TEST_F(CountsFile, holds_members_on_other_cells_and_those_left_out) {
  EnsembleCounts counts = empty_counts(test::ensemble_scene(), 4, {0, 4}, {});
  counts.deposit_quantum = 1e-6;
  counts.other_cells = true;
  const RunMaps maps = test::member_maps(counts.scene, 12, 2);
  RunMaps coarse = test::member_maps(counts.scene, 12, 2);  // the same lower left quarter, in cells twice as large
  coarse.grid.cell *= 2;
  counts.add(0, maps, {});
  counts.add(1, coarse, {});
  counts.leave_out(2, "no survey");
  counts.leave_out(3, "");
  counts.changes = {{1, "cells twice as large\nkey=1"}};
  write_counts(scratch / "counts.h5", counts);
  const EnsembleCounts read = read_counts(scratch / "counts.h5");
  test::expect_same(read, counts, &EnsembleCounts::states, &EnsembleCounts::failures, &EnsembleCounts::changes);
  EXPECT_EQ(read.grid_of(0).cell, counts.scene.grid.cell);
  EXPECT_EQ(read.grid_of(1).cell, coarse.grid.cell);
  const std::vector<double> kept = read.deposit_thickness[1].thickness(coarse.grid.count());
  const std::vector<std::uint8_t> covered = cells_of(read.deposit[1], counts.scene.grid.count());
  for (int row = 0; row < counts.scene.grid.rows; ++row)
    for (int column = 0; column < counts.scene.grid.columns; ++column) {
      const std::size_t fine = counts.scene.grid.index(column, row), of = coarse.grid.index(column / 2, row / 2);
      EXPECT_NEAR(kept[of], std::fmax(coarse.deposit_thickness[of], 0), 1e-6);
      EXPECT_EQ(covered[fine] != 0, coarse.deposit_thickness[of] > counts.scene.threshold);
    }
}

TEST_F(CountsFile, whose_deposits_are_not_of_their_footprints_is_refused) {
  EnsembleCounts counts = empty_counts(test::ensemble_scene(), 1, {0, 1}, {});
  counts.deposit_quantum = 1e-3;
  counts.add(0, test::member_maps(counts.scene, 12, 2), {});
  counts.deposit_thickness[0].values.pop_back();
  write_counts(scratch / "counts.h5", counts);
  EXPECT_TRUE(
      holds(data_fault([&] { read_counts(scratch / "counts.h5"); }), {"/members/deposit_thickness/values has"}));
}

TEST_F(CountsFile, of_a_part_in_which_nothing_came_anywhere_comes_back) {
  const EnsembleCounts counts = empty_counts(test::ensemble_scene(), 4, {0, 4}, {});
  write_counts(scratch / "counts.h5", counts);
  expect_same_counts(read_counts(scratch / "counts.h5"), counts);
}

TEST_F(CountsFile, that_is_missing_cut_short_or_something_else_is_refused) {
  const fs::path file = scratch / "counts.h5";
  EXPECT_TRUE(holds(data_fault([&] { read_counts(file); }), {"counts.h5: no such file"}));
  write_counts(file, test::part_of_ensemble(test::ensemble_table(3), {0, 3}));
  const std::string bytes = test::text_of(file);
  for (const double share : {0.1, 0.5, 0.9, 0.999}) {
    scratch.write("counts.h5", bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    EXPECT_NE(data_fault([&] { read_counts(file); }), "") << "cut to " << share;
  }
  write_member_table(file, test::ensemble_table(3));
  EXPECT_TRUE(holds(data_fault([&] { read_counts(file); }), {"is not counts of an ensemble"}));
}

TEST_F(CountsFile, with_changed_bytes_is_refused_by_its_seal) {
  write_counts(scratch / "counts.h5", test::part_of_ensemble(test::ensemble_table(3), {0, 3}));
  const std::string bytes = test::text_of(scratch / "counts.h5");
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::string damaged = test::damaged(bytes, seed);
    if (damaged == bytes) continue;
    scratch.write("counts.h5", damaged);
    EXPECT_NE(data_fault([&] { read_counts(scratch / "counts.h5"); }), "") << "seed " << seed;
  }
}

TEST_F(CountsFile, keeps_what_members_found_and_parts_add_it_up) {
  const MemberTable table = test::ensemble_table(30);
  const MemberRange ranges[] = {{20, 30}, {0, 9}};
  std::vector<EnsembleCounts> parts;
  for (const MemberRange& range : ranges) {
    EnsembleCounts part = test::part_of_ensemble(table, range);
    part.findings = {test::finding(Severity::warning, "coarse-grid", "coarse")};
    for (const auto& [member, name] : {std::pair{3, "packed"}, {1, "packed"}, {1, "fast"}})
      part.add_finding(range.first + member, test::finding(Severity::warning, name, "words"));
    write_counts(scratch / "counts.h5", part);
    parts.push_back(read_counts(scratch / "counts.h5"));
    expect_same_counts(parts.back(), part);
  }
  std::string all;
  for (const Finding& finding : merged(std::move(parts), {"counts.20-30.h5", "counts.0-9.h5"}).findings)
    all += finding.name + " " + std::to_string(finding.member) + ", ";
  EXPECT_EQ(all, "coarse-grid -1, packed 1, fast 1, packed 3, packed 21, fast 21, packed 23, ");
}

TEST_F(CountsFile, with_counts_that_cannot_be_is_refused) {
  const auto fault_of_changed = [&](const std::function<void(EnsembleCounts&)>& change) {
    EnsembleCounts counts = test::part_of_ensemble(test::ensemble_table(6), {0, 6}, 3);
    change(counts);
    write_counts(scratch / "counts.h5", counts);
    return data_fault([&] { read_counts(scratch / "counts.h5"); });
  };
  EXPECT_EQ(fault_of_changed([](EnsembleCounts&) {}), "");
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.maps[0].exceeded[0][200] = 7; }), "") << "more than members";
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.maps[1].reached[200] = 5; }), "") << "more than counted";
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.failures[0].member = 99; }), "") << "no such member";
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.failures.clear(); }), "") << "a failure without words";
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.add_finding(6, {}); }), "");
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.flow[0].clear(); }), "") << "counted, without a footprint";
  EXPECT_NE(fault_of_changed([](EnsembleCounts& c) { c.flow[0] = {10, 5}; }), "") << "not of this grid";
}

TEST(MemberTable, comes_back_as_it_was_written) {
  const test::Scratch scratch;
  MemberTable table = test::ensemble_table(6);
  table.own_domain = {0, 1, 1, 0, 1, 0};
  table.failures = {{1, "the source is empty: threshold_m = 90"}, {4, "two\nlines"}};
  table.provenance = {{recipe_of_members, "aabb"}};
  write_member_table(scratch / "members.h5", table);
  const MemberTable read = read_member_table(scratch / "members.h5");
  EXPECT_EQ(read.design, table.design);
  EXPECT_EQ(read.count, 6);
  ASSERT_EQ(read.columns.size(), table.columns.size());
  for (std::int64_t k = 0; k < 6; ++k) EXPECT_EQ(read.values_of(k, ""), table.values_of(k, ""));
  test::expect_same(read, table, &MemberTable::own_domain, &MemberTable::failures, &MemberTable::provenance);
}

TEST(MemberTable, tells_why_a_member_has_no_domain_and_is_refused_with_a_failure_of_none) {
  MemberTable table = test::ensemble_table(6);
  table.failures = {{4, "the source is empty"}};
  EXPECT_EQ(table.failure_of(3), nullptr);
  ASSERT_NE(table.failure_of(4), nullptr);
  EXPECT_EQ(table.failure_of(4)->words, "the source is empty");
  const test::Scratch scratch;
  for (const std::int64_t member : {std::int64_t{-1}, std::int64_t{6}}) {
    table.failures = {{member, "the source is empty"}};
    write_member_table(scratch / "members.h5", table);
    EXPECT_TRUE(test::holds(test::fault_of<DataError>([&] { read_member_table(scratch / "members.h5"); }),
                            {"group /failures names member " + std::to_string(member)}));
  }
}

TEST(EnsemblePaths, find_the_counts_of_all_members_before_those_of_parts) {
  const test::Scratch scratch;
  const EnsemblePaths paths{scratch.folder()};
  EXPECT_TRUE(paths.found_counts().empty());
  for (const char* name : {"counts.100-200.h5", "counts.20-100.h5", "counts.0-20.h5", "counts.x-3.h5", "counts.5.h5"})
    scratch.write(name, "");
  const std::vector<std::filesystem::path> parts{scratch / "counts.0-20.h5", scratch / "counts.20-100.h5",
                                                 scratch / "counts.100-200.h5"};
  EXPECT_EQ(paths.found_counts(), parts) << "by their members, not by their letters";
  scratch.write("counts.h5", "");
  EXPECT_EQ(paths.found_counts(), std::vector<std::filesystem::path>{scratch / "counts.h5"});
}

const std::string heading = "[ensemble]\ndesign = \"budget\"\n[ensemble.budget]\n";

EnsembleOptions options_in(const std::string& table) {
  const test::Scratch scratch;
  return ensemble_of(recipe::Recipe(scratch.write("recipe.toml", table)));
}

void expect_refused(const std::string& table, const std::string& words) {
  EXPECT_TRUE(test::holds(test::fault_of<RecipeError>([&] { options_in(table); }), {words})) << table;
}

TEST(BudgetOptions, are_those_of_no_budget_where_the_recipe_says_nothing_and_of_the_old_table_refused) {
  EXPECT_FALSE(options_in("[solve]\n").on());
  const EnsembleOptions some = options_in(heading + "leave_out = [\"cells\"]\n");
  EXPECT_TRUE(some.on());
  EXPECT_TRUE(some.is_budget());
  EXPECT_FALSE(some.budget.has("cells"));
  expect_refused("[budget]\ncell_factor = 3.0\n", "Give its keys in [ensemble.budget], with design = \"budget\"");
}

TEST(BudgetOptions, refuse_what_no_row_is_and_what_changes_nothing) {
  expect_refused(heading + "leave_out = [\"cell\"]\n", "cell");
  expect_refused(heading + "cells = 2\n", "unknown key");
  expect_refused(heading + "cell_factor = 1.0\n", "the other run would be the same");
  expect_refused(heading + "modulus_factor = 3.0\n", "the modulus is doubled");
  expect_refused(heading + "step_factor = 0.1\n", "steps are halved");
  expect_refused(heading + "[ensemble.elevation_error]\nterrain_deviation_m = 1.0\n",
                 "[ensemble.elevation_error] range_m is missing");
  std::string all;
  for (const BudgetRow& row : budget_rows)
    if (row.name != std::string("own") && row.name != std::string("own-numerical"))
      all += std::string("\"") + row.name + "\", ";
  expect_refused(heading + "leave_out = [" + all + "]\n", "names all rows");
  const std::string own = "[[ensemble.budget.run]]\nname = \"law\"\nset = [\"solve.base.law=voellmy\"]\n";
  EXPECT_EQ(options_in(heading + "leave_out = [" + all + "]\n" + own).budget.changes.size(), 1u)
      << "a run of its own is left";
  expect_refused(heading + own + own, "[[ensemble.budget.run]] \"law\" is there twice");
  expect_refused(heading + "[[ensemble.budget.run]]\nname = \"a/b\"\nset = [\"solve.cfl=0.1\"]\n", "letters, digits");
  expect_refused(heading + "[[ensemble.budget.run]]\nname = \"nothing\"\n", "sets nothing");
}

TEST(BudgetOptions, list_the_recipe_itself_and_every_row_that_is_not_left_out) {
  std::string names;
  for (const BudgetMember& member :
       budget_members(options_in(heading + "leave_out = [\"transfer\", \"weakening\"]\nsurvey_draws = 2\n"
                                           "[[ensemble.budget.run]]\nname = \"other\"\nset = [\"solve.cfl=0.1\"]\n")
                          .budget))
    names += member.name + (member.name.starts_with(member.row) ? " " : " of " + member.row + " ");
  EXPECT_EQ(names,
            "recipe repeat step modulus integrator cells friction-less friction-more drag-less drag-more strength-less "
            "strength-more survey-1 survey-2 other of own ");
}

}  // namespace
}  // namespace talus
