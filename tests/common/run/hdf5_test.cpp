// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the layer over HDF5 refuses: datasets of another kind or shape than asked for, and shapes without data.
#include "common/run/hdf5.hpp"

#include <numeric>

#include "common/run/sealed_file.hpp"
#include "common/stage/checksum.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

struct Hdf5Reading : test::InScratch {
  Hdf5Reading() {
    h5::File out = h5::File::create(path_, {path_, ""});
    out.write<double>("/reals", {2, 3}, std::vector<double>{0, 1, 2, 3, 4, 5});
    out.write<std::int32_t>("/wholes", {4}, std::vector<std::int32_t>{1, 2, 3, 4});
    const std::vector<std::int64_t> two{1, 2};
    out.set_integers("/", "two", two);
    out.set_number("/", "real", 0.5);
    out.close();
    claim_more_than_there_is();
  }

  /// Grows a dataset without writing anything into it: a shape of which the file holds nothing.
  void claim_more_than_there_is() const {
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hsize_t dims = hsize_t{1} << 40, chunk = 1024;
    const hid_t space = H5Screate_simple(1, &dims, nullptr), list = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(list, 1, &chunk);
    const hid_t set = H5Dcreate2(file, "/claim", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT);
    H5Dclose(set);
    H5Pclose(list);
    H5Sclose(space);
    H5Fclose(file);
  }

  template <class Read>
  std::string fault(Read&& read) const {
    const h5::File file = h5::File::open(path_, {path_, "Mend it"});
    const std::string text = test::fault_of<DataError>([&] { read(file); });
    return text.empty() ? text : text.substr(path_.string().size());
  }

  const std::filesystem::path path_ = scratch / "file.h5";
};

TEST_F(Hdf5Reading, refuses_values_of_another_kind) {
  EXPECT_EQ(fault([](const h5::File& file) { file.read_list<double>("/wholes"); }),
            ": dataset /wholes holds values of another kind (real numbers are asked for). Mend it");
  EXPECT_EQ(fault([](const h5::File& file) {
              file.read<std::int32_t>("/reals", {2, 3});
            }),
            ": dataset /reals holds values of another kind (whole numbers are asked for). Mend it");
  EXPECT_NE(fault([](const h5::File& file) { file.integer("/", "real"); }), "");
  EXPECT_NE(fault([](const h5::File& file) { file.integer("/", "two"); }), "");
  EXPECT_NE(fault([](const h5::File& file) { file.text("/", "real"); }), "");
}

TEST_F(Hdf5Reading, refuses_other_shapes) {
  EXPECT_EQ(fault([](const h5::File& file) {
              file.read<double>("/reals", {3, 2});
            }),
            ": dataset /reals has shape 2 x 3 (the rest of the file asks for 3 x 2). Mend it");
  EXPECT_EQ(fault([](const h5::File& file) { file.read_list<double>("/reals"); }),
            ": dataset /reals has shape 2 x 3 (a list is asked for). Mend it");
  EXPECT_EQ(fault([](const h5::File& file) { file.read_rows<double>("/reals", 1, 2, {3}); }),
            ": dataset /reals has shape 2 x 3 (the rest of the file speaks of rows 1 to 3). Mend it");
  EXPECT_EQ(fault([](const h5::File& file) { file.read_rows<double>("/reals", 0, 1, {4}); }),
            ": dataset /reals has shape 2 x 3 (rows of 4 are asked for). Mend it");
  EXPECT_NE(fault([](const h5::File& file) { file.read_rows<double>("/reals", ~hsize_t{0}, 2, {3}); }), "")
      << "the sum of first and rows overflows";
}

TEST_F(Hdf5Reading, refuses_a_shape_of_which_the_file_holds_nothing) {
  EXPECT_EQ(fault([](const h5::File& file) { file.read_list<double>("/claim"); }),
            ": dataset /claim has shape 1099511627776 (but only 0 bytes in the file). Mend it");
}

TEST_F(Hdf5Reading, does_not_take_what_cannot_be_read_for_missing) {
  {
    h5::File out = h5::File::create(path_, {path_, ""});
    out.make_group("/group");
    for (int n = 0; n < 40; ++n) out.set_integer("/group", "number " + std::to_string(n), n);  // beyond its header
    out.write<double>("/group/reals", {1}, std::vector<double>{0.5});
    out.close();
  }
  EXPECT_EQ(fault([](const h5::File& file) { EXPECT_TRUE(file.exists("/group/reals")); }), "");
  std::string bytes = test::text_of(path_);
  const std::size_t begin = 200;  // the root's own header is read as the file is opened
  std::fill(bytes.begin() + begin, bytes.end(), '\x5a');
  scratch.write("file.h5", bytes);
  EXPECT_NE(fault([](const h5::File& file) { file.exists("/group/reals"); }), "");
  EXPECT_NE(fault([](const h5::File& file) { file.exists("/group/others"); }), "");
  EXPECT_NE(fault([](const h5::File& file) { file.has_attribute("/group", "number 1"); }), "");
}

TEST_F(Hdf5Reading, names_place_and_value_of_what_cannot_be) {
  const auto checked = [](const h5::Allowed& allowed, const std::vector<double>& values) {
    return [=](const h5::File& file) { h5::check_values<double>(file, "/x", values, allowed); };
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault(checked(h5::finite, {0, -1e29})), "");
  EXPECT_EQ(fault(checked(h5::finite, {0, -1e30})),
            ": dataset /x holds -1e+30 at place 1 (-5e+29 to 5e+29 is possible). Mend it");
  EXPECT_EQ(fault(checked(h5::finite, {0, nan})),
            ": dataset /x holds nan at place 1 (-5e+29 to 5e+29 is possible). Mend it");
  EXPECT_NE(fault(checked(h5::finite_or_none, {inf})), "");
  EXPECT_EQ(fault(checked(h5::finite_or_none, {nan})), "");
  EXPECT_NE(fault(checked(h5::not_negative, {-1e-300})), "");
  EXPECT_EQ(fault(checked(h5::not_negative_or_none, {nan, 0, 1e29})), "");
  EXPECT_EQ(fault(checked(h5::thickness_or_none, {nan, 0, 2e5})),
            ": dataset /x holds 200000 at place 2 (0 to 100000 is possible, or NaN for none). Mend it");
}

std::vector<double> counting(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 0.25);
  return values;
}

/// A dataset as HDF5 itself reads it.
std::vector<double> as_hdf5_reads(const std::filesystem::path& path, const char* name, std::size_t count) {
  const h5::Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const h5::Id set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  std::vector<double> values(count);
  EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  return values;
}

// Chunks are packed and unpacked outside HDF5: maps of 60,000 cells are stored in two chunks each, rows of a growing
// dataset in one for every 1,024.
TEST(Hdf5Chunks, hold_the_same_for_hdf5_and_for_any_rows_that_are_asked_for) {
  const test::Scratch scratch;
  const auto path = scratch / "file.h5";
  const auto maps = counting(std::size_t{4} * 300 * 200), rows = counting(std::size_t{7070} * 3);
  {
    h5::File out = h5::File::create(path, {path, ""});
    out.write<double>("/maps", {4, 300, 200}, maps);
    const std::span<const double> all(rows);
    out.append<double>("/rows", 10, {3}, all.first(30));
    out.append<double>("/rows", 5000, {3}, all.subspan(30, 15000));
    out.append<double>("/rows", 2060, {3}, all.subspan(15030));
    out.close();
  }
  EXPECT_EQ(as_hdf5_reads(path, "/maps", maps.size()), maps);
  EXPECT_EQ(as_hdf5_reads(path, "/rows", rows.size()), rows);
  const h5::File file = h5::File::open(path, {path, ""});
  EXPECT_EQ(file.read<double>("/maps", {4, 300, 200}), maps);
  const auto part = [](const std::vector<double>& of, std::size_t row, std::size_t first, std::size_t count) {
    const auto begin = of.begin() + static_cast<std::ptrdiff_t>(row * first);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(row * count));
  };
  EXPECT_EQ(file.read_rows<double>("/maps", 1, 2, {300, 200}), part(maps, 60000, 1, 2));
  for (const auto& [first, count] : std::vector<std::pair<std::size_t, std::size_t>>{
           {0, 7070}, {0, 1}, {1023, 2}, {1024, 1024}, {5, 3000}, {7069, 1}, {7070, 0}})
    EXPECT_EQ(file.read_rows<double>("/rows", first, count, {3}), part(rows, 3, first, count)) << first;
}

TEST(Hdf5Chunks, of_other_filters_are_read_and_damaged_ones_refused) {
  const test::Scratch scratch;
  const auto path = scratch / "file.h5";
  const auto values = counting(5000);
  const hsize_t dims = values.size(), chunk = 1000;
  haddr_t place = 0;
  hsize_t bytes = 0;
  for (const bool shuffled : {false, true}) {
    const h5::Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    const h5::Id space(H5Screate_simple(1, &dims, nullptr), H5Sclose), list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(list, 1, &chunk);
    if (shuffled) H5Pset_shuffle(list);
    H5Pset_deflate(list, 9);
    const h5::Id set(H5Dcreate2(file, "/x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose);
    ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Fflush(file, H5F_SCOPE_LOCAL);
    EXPECT_EQ(h5::File::open(path, {path, ""}).read_list<double>("/x"), values) << shuffled;
    unsigned filters = 0;
    const hsize_t third = 2000;
    ASSERT_GE(H5Dget_chunk_info_by_coord(set, &third, &filters, &place, &bytes), 0);
  }
  std::string text = test::text_of(path);
  text[place + bytes / 2] = static_cast<char>(~text[place + bytes / 2]);
  scratch.write("file.h5", text);
  const h5::File file = h5::File::open(path, {path, "Mend it"});
  EXPECT_EQ(file.read_rows<double>("/x", 0, 2000, {}).back(), values[1999]);
  EXPECT_NE(test::fault_of<DataError>([&] { file.read_list<double>("/x"); }).find("dataset /x cannot be read"),
            std::string::npos);
}

constexpr h5::Format known_format{"talus-test", "a test"};

/// The fault of a file with that format, without the file's name.
std::string sealed_fault(const h5::Format& written, bool sealed = true) {
  const test::Scratch scratch;
  const auto path = scratch / "file.h5";
  h5::File file = h5::File::create(path, {path, ""});
  h5::set_format(file, written);
  file.close();
  if (sealed) seal_file(path, path);
  const auto fault = test::fault_of<DataError>([&] { h5::open_sealed(path, {path, "Make it again"}, known_format); });
  return fault.empty() ? fault : fault.substr(path.string().size());
}

TEST(SealedFile, is_opened_with_the_known_mark_and_number_and_a_seal) {
  EXPECT_EQ(sealed_fault(known_format), "");
  EXPECT_EQ(sealed_fault({"talus-other", "another"}), ": is not a test (its mark is missing). Make it again");
  EXPECT_EQ(sealed_fault({"talus-test", "a test", 4}), ": format 4 (this version reads 1). Make it again");
  EXPECT_EQ(
      sealed_fault(known_format, false),
      ": is damaged (its checksum is missing: another program wrote or changed it, or its end is lost). Make it again");
  const h5::Naming missing{"/no/such.h5", "Make it"};
  EXPECT_EQ(test::fault_of<DataError>([&] { h5::open_sealed("/no/such.h5", missing); }),
            "/no/such.h5: no such file. Make it");
}

}  // namespace
}  // namespace talus
