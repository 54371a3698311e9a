// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The files of an ensemble in its output folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Members first <= k < end, counted from 0.
struct MemberRange {
  std::int64_t first = 0, end = 0;
  /// Number of members.
  std::int64_t count() const { return end - first; }
  bool operator==(const MemberRange&) const = default;
};

/// The names of an ensemble's files in the output folder `out`.
struct EnsemblePaths {
  std::filesystem::path out;

  /// The table of members, which talus-preprocess writes.
  std::filesystem::path members() const { return out / "members.h5"; }
  /// The domain of a member that has one of its own.
  std::filesystem::path domain(std::int64_t member) const;
  /// The folder of the members' own domains, and of whole runs that are kept.
  std::filesystem::path folder() const { return out / "members"; }
  /// The counts of all members.
  std::filesystem::path counts() const { return out / "counts.h5"; }
  /// The counts of a part.
  std::filesystem::path counts(const MemberRange& part) const;
  /// What a computation of a part that was stopped has finished.
  std::filesystem::path unfinished(const MemberRange& part) const;
  /// The folder of a member whose whole run is kept.
  std::filesystem::path run_folder(std::int64_t member) const;
  /// The files of counts in the folder: counts.h5, else those of parts in the order of their members.
  std::vector<std::filesystem::path> found_counts() const;
};

}  // namespace talus
