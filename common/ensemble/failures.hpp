// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members of an ensemble that failed, and why: in members.h5 those whose domain cannot be made, in counts.h5 all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace talus {

namespace h5 {
class File;
}

/// A member that failed, and why.
struct MemberFailure {
  std::int64_t member = 0;
  std::string words;
  bool operator==(const MemberFailure&) const = default;
};

/// Writes them as group /failures.
void write_failures(h5::File& file, const std::vector<MemberFailure>& failures);

/// Reads them back; a file without the group has none. Throws DataError.
std::vector<MemberFailure> read_failures(const h5::File& file);

}  // namespace talus
