// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/domain.hpp"

#include <openvdb/openvdb.h>

#include <functional>
#include <numeric>

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

struct DomainFile : testing::Test {
  const Scratch scratch;
};

TEST_F(DomainFile, round_trip_keeps_everything) {
  const Domain domain = sample(20000);
  write_domain(scratch / "domain.vdb", domain);
  EXPECT_EQ(scratch.files(), 1u);
  const Domain back = read_domain(scratch / "domain.vdb");
  EXPECT_TRUE(test::identical(back.terrain, domain.terrain));
  EXPECT_TRUE(test::identical(back.before, domain.before));
  EXPECT_TRUE(test::identical(back.release_thickness, domain.release_thickness));
  EXPECT_EQ(back.grid.crs_wkt, domain.grid.crs_wkt);
  EXPECT_EQ(back.layer_height, domain.layer_height);
  EXPECT_EQ(back.release_names, domain.release_names);
  EXPECT_EQ(back.provenance, domain.provenance);
  EXPECT_EQ(back.points.volume, domain.points.volume);
  EXPECT_EQ(back.points.height, domain.points.height);
  EXPECT_EQ(back.points.extent_x, domain.points.extent_x);
  EXPECT_EQ(back.points.extent_y, domain.points.extent_y);
  EXPECT_EQ(back.points.release, domain.points.release);
  EXPECT_EQ(back.active, active_cells(domain.grid, domain.layer_height, domain.points));
  ASSERT_EQ(back.points.size(), domain.points.size());
  for (std::size_t p = 0; p < back.points.size(); ++p) {
    ASSERT_NEAR(back.points.x[p], domain.points.x[p], 1e-6 * domain.grid.cell);
    ASSERT_NEAR(back.points.y[p], domain.points.y[p], 1e-6 * domain.grid.cell);
  }
}

TEST_F(DomainFile, places_come_back_to_the_last_bit_and_may_be_absent) {
  Domain domain = sample(5);
  write_domain(scratch / "none.vdb", domain);
  EXPECT_TRUE(read_domain(scratch / "none.vdb").places.empty());
  domain.places = {{"sections", "road", {{512400.1, 5432200.0 / 3 * 3}, {512500, 5432300}}},
                   {"gauges", "bridge", {{512400 + 1 / 3.0, 5432200}}}};
  write_domain(scratch / "domain.vdb", domain);
  EXPECT_EQ(read_domain(scratch / "domain.vdb").places, domain.places);
}

TEST_F(DomainFile, a_domain_without_points_can_be_written) {
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
  const std::string list = text_of(scratch / "list.txt");
  EXPECT_TRUE(test::holds(list, {"Name: points", "Name: terrain", "Name: before", "Name: release_thickness",
                                 "Name: inside", "Name: active", "ptdataidx32", "kind: talus-domain",
                                 "crs_wkt: LOCAL_CS", "release_name.0: upper", "cell_m: 20", "h_m: 20", "h_z_m: 5"}));
}

constexpr auto unsealed =
    ": is damaged (its checksum is missing: another program wrote or changed it, or its end is lost). Run "
    "talus-preprocess again, or copy it again";

TEST_F(DomainFile, every_truncation_is_noticed) {
  write_domain(scratch / "domain.vdb", sample(50));
  const std::string whole = text_of(scratch / "domain.vdb");
  for (std::size_t length = 0; length < whole.size(); length += length < 200 ? 13 : 1511) {
    const auto cut = scratch.write("cut.vdb", whole.substr(0, length));
    EXPECT_EQ(fault_of<DataError>([&] { read_domain(cut); }), cut.string() + unsealed) << length << " bytes";
  }
  for (const std::size_t lost : {1u, 64u, 128u}) {  // the contents are whole
    const auto cut = scratch.write("cut.vdb", whole.substr(0, whole.size() - lost));
    EXPECT_EQ(fault_of<DataError>([&] { read_domain(cut); }), cut.string() + unsealed) << lost << " bytes lost";
  }
}

TEST_F(DomainFile, foreign_files_are_refused) {
  const auto words = scratch.write("words.vdb", "these are words, not volumes");
  EXPECT_EQ(fault_of<DataError>([&] { read_domain(words); }), words.string() + unsealed);
  seal_file(words, words);
  EXPECT_TRUE(fault_of<DataError>([&] { read_domain(words); }).starts_with(words.string() + ": cannot be read (the "))
      << "OpenVDB refuses it";
  const auto missing = scratch / "none.vdb";
  EXPECT_EQ(fault_of<DataError>([&] { read_domain(missing); }),
            missing.string() + ": no such file. Run talus-preprocess first, with the same --out");
  EXPECT_EQ(fault_of<DataError>([&] { read_domain(scratch.folder()); }),
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

TEST_F(DomainFile, another_format_is_refused) {
  EXPECT_EQ(fault_after([](const auto&, auto& header, auto&) {
              header.removeMeta("format");
              header.insertMeta("format", openvdb::Int64Metadata(4));
            }),
            ": format 4 (this version reads 1). Run talus-preprocess again");
}

TEST_F(DomainFile, a_changed_byte_is_noticed_before_openvdb_sees_it) {
  write_domain(scratch / "domain.vdb", sample(50));
  const std::string whole = text_of(scratch / "domain.vdb");
  for (std::size_t place = 20; place < whole.size() - 128; place += 997) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 0x40);
    const auto file = scratch.write("changed.vdb", changed);
    EXPECT_TRUE(fault_of<DataError>([&] {
                  read_domain(file);
                }).starts_with(file.string() + ": is damaged (bytes have changed since it was written"))
        << place;
  }
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

TEST_F(DomainFile, places_without_points_are_refused) {
  EXPECT_EQ(fault_after([](const auto&, auto& header, auto&) {
              header.insertMeta("places", openvdb::Int64Metadata(1));
              header.insertMeta("place_of.0", openvdb::StringMetadata("set"));
              header.insertMeta("place_name.0", openvdb::StringMetadata("a"));
              header.insertMeta("place_points.0", openvdb::StringMetadata("1,2 3"));
            }),
            ": not a whole domain (the entry \"place_points.0\" holds no points). Make it with talus-preprocess");
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
  const std::string text = fault_of<DataError>([&] {
    const test::SmallFiles limit(200000);
    write_domain(scratch / "domain.vdb", domain);
  });
  EXPECT_TRUE(text.starts_with((scratch / "domain.vdb").string() + ": cannot be written (")) << text;
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
