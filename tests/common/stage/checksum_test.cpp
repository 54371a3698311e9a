// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A sealed file says of itself whether it is whole.
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

constexpr auto seal_mend = "Make it again";

struct Seal : testing::Test {
  const test::Scratch scratch;
};

TEST_F(Seal, a_sealed_file_is_whole_and_longer_by_one_line) {
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

TEST_F(Seal, a_changed_byte_anywhere_is_noticed) {
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

TEST_F(Seal, a_file_with_bytes_missing_in_front_of_its_seal_is_refused_in_words) {
  const auto file = scratch.write("file", std::string(300, 'x'));
  seal_file(file, file);
  scratch.write("file", test::text_of(file).substr(1));
  EXPECT_EQ(test::fault_of<DataError>([&] { check_seal(file, seal_mend); }),
            file.string() + ": is damaged (it holds 299 bytes, its last line speaks of 300). Make it again");
}

TEST_F(Seal, a_cut_file_has_none) {
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

TEST(Sha256, matches_published_vectors) {
  const test::Scratch scratch;
  EXPECT_EQ(sha256(scratch.write("empty", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256(scratch.write("abc", "abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text("abc"), sha256(scratch / "abc"));
  EXPECT_EQ(sha256(scratch.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(scratch.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, says_what_it_cannot_read) {
  EXPECT_EQ(test::fault_of<DataError>([] { sha256("/no/such"); }),
            "/no/such: cannot be read (No such file or directory). Check the path and its permissions");
}

}  // namespace
}  // namespace talus
