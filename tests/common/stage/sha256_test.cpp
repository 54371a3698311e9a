// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/stage.hpp"

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;

TEST(Sha256, matches_published_vectors) {
  const Scratch scratch;
  EXPECT_EQ(sha256(scratch.write("empty", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256(scratch.write("abc", "abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text("abc"), sha256(scratch / "abc"));
  EXPECT_EQ(sha256(scratch.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(scratch.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, says_what_it_cannot_read) {
  EXPECT_EQ(fault_of<DataError>([] { sha256("/no/such"); }),
            "/no/such: cannot be read (No such file or directory). Check the path and its permissions");
}

}  // namespace
}  // namespace talus
