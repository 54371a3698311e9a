// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which HDF5 files are read at all.
#include "common/run/sealed_file.hpp"

#include "common/stage/checksum.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

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

TEST(SealedFile, of_the_known_mark_and_number_is_opened) { EXPECT_EQ(sealed_fault(known_format), ""); }

TEST(SealedFile, of_another_mark_or_number_is_refused) {
  EXPECT_EQ(sealed_fault({"talus-other", "another"}), ": is not a test (its mark is missing). Make it again");
  EXPECT_EQ(sealed_fault({"talus-test", "a test", 4}), ": format 4 (this version reads 1). Make it again");
}

TEST(SealedFile, without_a_seal_is_refused) {
  EXPECT_EQ(sealed_fault(known_format, false),
            ": is damaged (its checksum is missing: another program wrote or changed it, or its end is lost). Make it "
            "again");
}

TEST(SealedFile, that_is_missing_is_named) {
  EXPECT_EQ(test::fault_of<DataError>([] {
              h5::open_sealed("/no/such.h5", {"/no/such.h5", "Make it"});
            }),
            "/no/such.h5: no such file. Make it");
}

}  // namespace
}  // namespace talus
