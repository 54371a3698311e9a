// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A sealed file says of itself whether it is whole.
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

constexpr auto seal_mend = "Make it again";

TEST(Seal, a_sealed_file_is_whole_and_longer_by_one_line) {
  const test::Scratch scratch;
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, (std::size_t{1} << 20) + 7}) {
    const std::string text(length, 'x');
    const auto file = scratch.write("file", text);
    EXPECT_FALSE(check_seal(file, seal_mend)) << length;
    seal_file(file, file);
    const std::string sealed = test::text_of(file);
    EXPECT_EQ(sealed.size(), length + 128);
    EXPECT_EQ(sealed.substr(0, length), text);
    EXPECT_TRUE(test::holds(sealed, {sha256_of_text(text)}));
    EXPECT_TRUE(check_seal(file, seal_mend)) << length;
  }
}

TEST(Seal, a_changed_byte_anywhere_is_noticed) {
  const test::Scratch scratch;
  const auto file = scratch.write("file", std::string(300, 'x'));
  seal_file(file, file);
  const std::string whole = test::text_of(file);
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    scratch.write("file", changed);
    bool sealed = false;
    const std::string fault = test::fault_of<DataError>([&] { sealed = check_seal(file, seal_mend); });
    EXPECT_FALSE(sealed) << "byte " << place;
    if (place < 300) {
      EXPECT_TRUE(fault.starts_with(file.string() + ": is damaged (bytes have changed since")) << place << fault;
    }
  }
}

TEST(Seal, a_file_with_bytes_missing_in_front_of_its_seal_is_refused_in_words) {
  const test::Scratch scratch;
  const auto file = scratch.write("file", std::string(300, 'x'));
  seal_file(file, file);
  scratch.write("file", test::text_of(file).substr(1));
  EXPECT_EQ(test::fault_of<DataError>([&] { check_seal(file, seal_mend); }),
            file.string() + ": is damaged (it holds 299 bytes, its last line speaks of 300). Make it again");
}

TEST(Seal, a_cut_file_has_none) {
  const test::Scratch scratch;
  const auto file = scratch.write("file", std::string(300, 'x'));
  seal_file(file, file);
  scratch.write("file", test::text_of(file).substr(0, 400));
  EXPECT_FALSE(check_seal(file, seal_mend));
}

TEST(Sha256, bytes_may_come_in_any_parts) {
  std::vector<std::uint8_t> bytes(1000);
  for (std::size_t n = 0; n < bytes.size(); ++n) bytes[n] = static_cast<std::uint8_t>(7 * n % 251);
  Sha256 whole;
  whole.add(bytes);
  const std::string digest = whole.digest();
  for (const std::size_t part : {1u, 3u, 63u, 64u, 65u, 127u, 128u, 200u}) {
    Sha256 sum;
    for (std::size_t first = 0; first < bytes.size(); first += part)
      sum.add(std::span(bytes).subspan(first, std::min(part, bytes.size() - first)));
    EXPECT_EQ(sum.digest(), digest) << part;
  }
}

}  // namespace
}  // namespace talus
