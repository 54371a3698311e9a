// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <functional>
#include <numeric>

#include <openvdb/openvdb.h>

#include "common/domain/active_cells.hpp"
#include "common/domain/domain.hpp"
#include "common/domain/domain_place.hpp"
#include "common/stage/checksum.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace fs = std::filesystem;

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;
using test::text_of;

/// A sloping domain far from the origin, one corner of it without ground, with random points.
Domain sample(std::size_t count, unsigned seed = 1) {
  Domain domain;
  domain.grid = {30, 20, 512345.25, 5432100.5, 20, "LOCAL_CS[\"test\"]"};
  domain.layer_height = 5;
  domain.terrain = test::random_raster(domain.grid, seed);
  domain.before = test::random_raster(domain.grid, seed + 1);
  domain.release_thickness = test::random_raster(domain.grid, seed + 2);
  domain.terrain.at(0, 0) = domain.before.at(0, 0) = domain.release_thickness.at(0, 0) = std::nan("");
  domain.release_names = {"upper", "lower"};
  domain.provenance = {{"version", "0.1.0"}, {"input", "before.tif sha256 abc"}, {"empty", ""}};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t p = 0; p < count; ++p) {
    domain.points.x.push_back(domain.grid.west + 600 * unit(random));
    domain.points.y.push_back(domain.grid.south + 400 * unit(random));
    domain.points.height.push_back(40 * unit(random));
    domain.points.volume.push_back(250 / 3.0 * unit(random));
    domain.points.extent_x.push_back(20 * unit(random));
    domain.points.extent_y.push_back(20 * unit(random));
    domain.points.release.push_back(static_cast<int>(p % 2));
  }
  return domain;
}

using DomainFile = test::InScratch;

TEST_F(DomainFile, round_trip_keeps_everything) {
  const Domain domain = sample(20000);
  write_domain(scratch / "domain.vdb", domain);
  EXPECT_EQ(scratch.files(), 1u);
  const Domain back = read_domain(scratch / "domain.vdb");
  EXPECT_TRUE(test::identical(back.terrain, domain.terrain));
  EXPECT_TRUE(test::identical(back.before, domain.before));
  EXPECT_TRUE(test::identical(back.release_thickness, domain.release_thickness));
  EXPECT_EQ(back.grid.crs_wkt, domain.grid.crs_wkt);
  test::expect_same(back, domain, &Domain::layer_height, &Domain::release_names, &Domain::provenance);
  test::expect_same(back.points, domain.points, &SeedPoints::volume, &SeedPoints::height, &SeedPoints::extent_x,
                    &SeedPoints::extent_y, &SeedPoints::release);
  EXPECT_EQ(back.active, active_cells(domain.grid, domain.layer_height, domain.points));
  ASSERT_EQ(back.points.size(), domain.points.size());
  for (std::size_t p = 0; p < back.points.size(); ++p) {
    ASSERT_NEAR(back.points.x[p], domain.points.x[p], 1e-6 * domain.grid.cell);
    ASSERT_NEAR(back.points.y[p], domain.points.y[p], 1e-6 * domain.grid.cell);
  }
}

TEST_F(DomainFile, places_come_back_to_the_last_bit_and_may_be_absent_as_points_may) {
  Domain domain = sample(5);
  write_domain(scratch / "none.vdb", domain);
  EXPECT_TRUE(read_domain(scratch / "none.vdb").places.empty());
  domain.places = {{"sections", "road", {{512400.1, 5432200.0 / 3 * 3}, {512500, 5432300}}},
                   {"gauges", "bridge", {{512400 + 1 / 3.0, 5432200}}}};
  write_domain(scratch / "domain.vdb", domain);
  EXPECT_EQ(read_domain(scratch / "domain.vdb").places, domain.places);
  write_domain(scratch / "domain.vdb", sample(0));
  const Domain back = read_domain(scratch / "domain.vdb");
  EXPECT_EQ(back.points.size(), 0u);
  EXPECT_EQ(back.active, ActiveCells(30, 20));
}

TEST_F(DomainFile, vdb_print_lists_it) {
  write_domain(scratch / "domain.vdb", sample(100));
  const std::string command =
      "vdb_print -l -m " + (scratch / "domain.vdb").string() + " > " + (scratch / "list.txt").string() + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0)
      << text_of(scratch / "list.txt") << "\nvdb_print is in the Debian package libopenvdb-tools";
  EXPECT_TRUE(test::holds(text_of(scratch / "list.txt"),
                          {"Name: points", "Name: terrain", "Name: before", "Name: release_thickness", "Name: inside",
                           "Name: active", "ptdataidx32", "kind: talus-domain", "crs_wkt: LOCAL_CS",
                           "release_name.0: upper", "cell_m: 20", "h_m: 20", "h_z_m: 5"}));
}

const std::string unsealed =
    ": is damaged (its checksum is missing: another program wrote or changed it, or its end is lost). Run "
    "talus-preprocess again, or copy it again";

TEST_F(DomainFile, every_truncation_and_changed_byte_is_noticed_before_openvdb_sees_it) {
  write_domain(scratch / "domain.vdb", sample(50));
  const std::string whole = text_of(scratch / "domain.vdb");
  for (std::size_t length = 0; length < whole.size(); length += length < 200 ? 13 : 1511) {
    const auto cut = scratch.write("cut.vdb", whole.substr(0, length));
    EXPECT_EQ(data_fault([&] { read_domain(cut); }), "./cut.vdb" + unsealed) << length << " bytes";
  }
  for (const std::size_t lost : {1u, 64u, 128u}) {  // the contents are whole
    const auto cut = scratch.write("cut.vdb", whole.substr(0, whole.size() - lost));
    EXPECT_EQ(data_fault([&] { read_domain(cut); }), "./cut.vdb" + unsealed) << lost << " bytes lost";
  }
  for (std::size_t place = 20; place < whole.size() - 128; place += 997) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 0x40);
    const auto file = scratch.write("changed.vdb", changed);
    const std::string fault = data_fault([&] { read_domain(file); });
    EXPECT_TRUE(test::begins(fault, "./changed.vdb: is damaged (bytes have changed since it was written")) << place;
  }
}

TEST_F(DomainFile, foreign_files_are_refused) {
  const auto words = scratch.write("words.vdb", "these are words, not volumes");
  EXPECT_EQ(data_fault([&] { read_domain(words); }), "./words.vdb" + unsealed);
  seal_file(words, words);
  EXPECT_TRUE(data_fault([&] { read_domain(words); }).starts_with("./words.vdb: cannot be read (the "))
      << "OpenVDB refuses it";
  const auto missing = scratch / "none.vdb";
  EXPECT_EQ(data_fault([&] { read_domain(missing); }),
            "./none.vdb: no such file. Run talus-preprocess first, with the same --out");
  EXPECT_EQ(data_fault([&] { read_domain(scratch.folder()); }),
            scratch.folder().string() + ": cannot be read (it is a folder). Check the path");
}

/// What reading says of a domain that was changed after it was written, without the file's name.
std::string fault_after(const std::function<void(const openvdb::GridPtrVec& grids, openvdb::MetaMap& header,
                                                 openvdb::MaskGrid& active)>& change) {
  const Scratch scratch;
  write_domain(scratch / "domain.vdb", sample(50));
  openvdb::io::File file((scratch / "domain.vdb").string());
  file.open(false);
  const auto grids = file.getGrids();
  const auto header = file.getMetadata();
  file.close();
  for (const auto& grid : *grids)
    if (grid->getName() == "active") change(*grids, *header, *openvdb::gridPtrCast<openvdb::MaskGrid>(grid));
  openvdb::io::File(file.filename()).write(*grids, *header);
  seal_file(file.filename(), file.filename());
  return fault_of<DataError>([&] { read_domain(scratch / "domain.vdb"); })
      .substr((scratch / "domain.vdb").string().size());
}

TEST_F(DomainFile, a_domain_that_was_only_copied_is_read) {
  EXPECT_THROW(fault_after([](const auto&, auto&, auto&) {}), std::out_of_range) << "there is no fault to cut";
}

TEST_F(DomainFile, another_format_and_places_without_points_are_refused) {
  EXPECT_EQ(fault_after([](const auto&, auto& header, auto&) {
              header.removeMeta("format");
              header.insertMeta("format", openvdb::Int64Metadata(4));
            }),
            ": format 4 (this version reads 1). Run talus-preprocess again");
  EXPECT_EQ(fault_after([](const auto&, auto& header, auto&) {
              header.insertMeta("places", openvdb::Int64Metadata(1));
              header.insertMeta("place_of.0", openvdb::StringMetadata("set"));
              header.insertMeta("place_name.0", openvdb::StringMetadata("a"));
              header.insertMeta("place_points.0", openvdb::StringMetadata("1,2 3"));
            }),
            ": not a whole domain (the entry \"place_points.0\" holds no points). Make it with talus-preprocess");
}

/// What reading says of a domain with one number changed in memory before it was written, without the file's name.
std::string fault_with(const std::function<void(Domain&)>& change) {
  const Scratch scratch;
  Domain domain = sample(50);
  change(domain);
  const std::string file = (scratch / "domain.vdb").string();
  const std::string fault = fault_of<DataError>([&] { write_domain(file, domain); });  // which reads it back
  return fault.empty() ? fault : fault.substr(file.size());
}

TEST_F(DomainFile, numbers_that_cannot_be_are_refused_with_their_place) {
  const std::string no_domain = ": cannot be written (it does not read back as written: ";
  const auto said = [&](const std::string& fault) { return fault.substr(0, fault.find("). Check")); };
  EXPECT_EQ(fault_with([](Domain&) {}), "");
  EXPECT_EQ(said(fault_with([](Domain& d) { d.terrain.at(3, 2) = 1e6; })),
            no_domain + "the grid \"terrain\" holds 1e+06 in column 3, row 2; -100000 to 100000 is possible");
  EXPECT_EQ(said(fault_with([](Domain& d) { d.release_thickness.at(3, 2) = -1; })),
            no_domain + "the grid \"release_thickness\" holds -1 in column 3, row 2; 0 to 100000 is possible");
  EXPECT_EQ(said(fault_with([](Domain& d) { d.points.release[7] = 2; })),
            no_domain + "point 7 is of release 2, of which there are 2");
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) { d.points.volume[7] = 0; }), {"\"volume\" of point 7 is 0"}));
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) { d.points.volume[7] = std::nan(""); }), {"of point 7 is nan"}));
  EXPECT_NE(fault_with([](Domain& d) { d.points.height[7] = std::nan(""); }), "");
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) { d.points.extent_x[7] = -1; }), {"of point 7 is -1"}));
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) { d.erodible = 3; }), {"3 of its 2 releases"}));
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) {
                            d.places = {{"set", "a b", {{d.grid.west, d.grid.south}}}};
                          }),
                          {"\"a b\" of the place \"set\" is no name"}));
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) {
                            d.places = {{"set", "a", {{d.grid.west, d.grid.south - 1}}}};
                          }),
                          {"\"a\" of the place \"set\" goes to"}));
  EXPECT_TRUE(test::holds(fault_with([](Domain& d) { d.bed = {{"colour", d.terrain}}; }), {"bed.colour"}));
}

TEST_F(DomainFile, masks_of_other_grids_are_refused) {
  const std::string no_domain = ": not a whole domain (the mask \"active\" ";
  EXPECT_EQ(fault_after([](const auto&, auto&, auto& active) {
              active.removeMeta("h_z_m");
              active.insertMeta("h_z_m", openvdb::DoubleMetadata(4));
            }),
            no_domain + "has other cells than the grid). Make it with talus-preprocess");
  EXPECT_EQ(
      fault_after([](const auto&, auto&, auto& active) { active.tree().setValueOn(openvdb::Coord(30, 0, 0), true); }),
      no_domain + "goes beyond the map). Make it with talus-preprocess");
  EXPECT_EQ(
      fault_after([](const auto&, auto&, auto& active) { active.tree().setValueOn(openvdb::Coord(3, 3, 99), true); }),
      no_domain + "is not made of whole blocks of 4 x 4 columns). Make it with talus-preprocess");
}

TEST_F(DomainFile, a_full_disk_leaves_no_half_file) {
  const Domain domain = sample(20000);
  EXPECT_TRUE(test::begins(full_disk_fault(200000, [&] { write_domain(scratch / "domain.vdb", domain); }),
                           "./domain.vdb: cannot be written ("));
  EXPECT_EQ(scratch.files(), 0u);
}

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

TEST(DomainPlace, points_come_back_to_the_last_bit_and_texts_that_are_none_are_told) {
  const MapLine points{{683080.1, 5497450.0 / 3}, {-0.0, 1e-300}, {std::nextafter(1, 2), 12}};
  EXPECT_EQ(points_in(text_of_points(points)), points);
  EXPECT_EQ(text_of_points({{1, 2.5}, {3, 4}}), "1,2.5 3,4");
  for (const char* text : {"", " ", "1", "1,", "1,2 ", "1,2,3", "1;2", "1,2  3,4", "a,b", "nan,1", "1,inf", "1,2\n"})
    EXPECT_FALSE(points_in(text)) << text;
}

/// A map of 30 x 21 cells of 10 m, and layers of 5 m.
const MapGrid map{30, 21, 1000, 2000, 10, ""};
constexpr double layer_height = 5;

/// A point at the middle of cell (column, row), `height` above the bed [m].
void add_point(SeedPoints& points, int column, int row, double height) {
  points.x.push_back(map.x(column));
  points.y.push_back(map.y(row));
  points.height.push_back(height);
}

/// Seeds without a volume: only their places count here.
SeedPoints random_points(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  SeedPoints points;
  for (int p = 0; p < count; ++p) {
    points.x.push_back(map.west + 300 * unit(random));
    points.y.push_back(map.south + 210 * unit(random));
    points.height.push_back(60 * unit(random));
  }
  return points;
}

TEST(ActiveCells, are_none_without_points_on_the_map) {
  const ActiveCells cells = active_cells(map, layer_height, {});
  EXPECT_EQ(cells.block_count(), 0u);
  EXPECT_EQ(cells.cell_count(), 0u);
  EXPECT_FALSE(cells.holds({0, 0, 0}));
  SeedPoints points;
  add_point(points, -2, 5, 0);
  add_point(points, 5, 21, 0);
  EXPECT_EQ(active_cells(map, layer_height, points).cell_count(), 0u) << "beyond it";
}

TEST(ActiveCells, a_point_has_its_block_and_one_ring) {
  SeedPoints points;
  add_point(points, 13, 9, 17);  // block (3, 2), nearest layer 3
  const ActiveCells cells = active_cells(map, layer_height, points);
  EXPECT_EQ(cells.block_count(), 9u);
  EXPECT_EQ(cells.cell_count(), 9u * 16u * 3u);
  for (int column = 0; column < map.columns; ++column)
    for (int row = 0; row < map.rows; ++row)
      for (int layer = -1; layer < 7; ++layer) {
        const bool near = column >= 8 && column < 20 && row >= 4 && row < 16 && layer >= 2 && layer <= 4;
        ASSERT_EQ(cells.holds({column, row, layer}), near) << column << ' ' << row << ' ' << layer;
      }
}

TEST(ActiveCells, blocks_are_cut_off_at_the_edge_of_the_map_and_span_the_layers_of_all_around) {
  SeedPoints points;
  add_point(points, 29, 20, 0);  // the last block has 2 columns and 1 row
  const ActiveCells cells = active_cells(map, layer_height, points);
  EXPECT_EQ(cells.block_count(), 4u);
  EXPECT_EQ(cells.cell_count(), 6u * 5u * 2u) << "layers 0 and 1: there is none below the bed";
  EXPECT_FALSE(cells.holds({30, 20, 0}));
  EXPECT_FALSE(cells.holds({-1, 0, 0}));
  points = {};
  add_point(points, 5, 5, 0);
  add_point(points, 13, 5, 50);  // two blocks further east, in layer 10
  const ActiveCells spanned = active_cells(map, layer_height, points);
  EXPECT_EQ(spanned.block_of(5, 5), (ActiveCells::Layers{0, 1}));
  EXPECT_EQ(spanned.block_of(9, 5), (ActiveCells::Layers{0, 11}));
  EXPECT_EQ(spanned.block_of(13, 5), (ActiveCells::Layers{9, 11}));
}

TEST(ActiveCells, every_point_and_all_cells_beside_it_are_active) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const SeedPoints points = random_points(40, seed);
    const ActiveCells cells = active_cells(map, layer_height, points);
    std::size_t counted = 0;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column)
        for (int layer = 0; layer < 20; ++layer) counted += cells.holds({column, row, layer}) ? 1u : 0u;
    EXPECT_EQ(cells.cell_count(), counted) << "seed " << seed;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto [column, row, layer] = nearest_cell(map, layer_height, points, p);
      ASSERT_NEAR(map.x(column), points.x[p], 5) << "seed " << seed;
      ASSERT_NEAR(map.y(row), points.y[p], 5) << "seed " << seed;
      ASSERT_NEAR(layer * layer_height, points.height[p], 2.5) << "seed " << seed;
      for (int beside = 0; beside < 27; ++beside) {
        const std::array<int, 3> cell{column + beside % 3 - 1, row + beside / 3 % 3 - 1, layer + beside / 9 - 1};
        const bool of_map = cell[0] >= 0 && cell[1] >= 0 && cell[0] < map.columns && cell[1] < map.rows && cell[2] >= 0;
        ASSERT_EQ(cells.holds(cell), of_map) << "seed " << seed << ", point " << p;
      }
    }
  }
}

}  // namespace
}  // namespace talus
