// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of members of an ensemble: in members.h5 why the domains of some cannot be made, in counts.h5 why some
// failed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace talus {

namespace h5 {
class File;
}

/// A member, and what is said of it.
struct MemberWords {
  std::int64_t member = 0;
  std::string words;
  bool operator==(const MemberWords&) const = default;
};

/// Adds words behind those of the same and of lower members.
void add_in_order(std::vector<MemberWords>& list, MemberWords words);

/// Writes them as numbered groups in `group`.
void write_member_words(h5::File& file, const std::string& group, const std::vector<MemberWords>& list);

/// Reads them back; a file without the group has none. Throws DataError.
std::vector<MemberWords> read_member_words(const h5::File& file, const std::string& group);

}  // namespace talus
