// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The files of an ensemble by their names, and members.h5: its members, which talus-preprocess draws and talus-solve
// runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "common/stage/identity.hpp"

namespace talus {

/// Members first <= k < end, counted from 0.
struct MemberRange {
  std::int64_t first = 0, end = 0;
  std::int64_t count() const { return end - first; }  ///< number of members
  bool operator==(const MemberRange&) const = default;
};

/// The names of an ensemble's files in the output folder `out`.
struct EnsemblePaths {
  std::filesystem::path out;

  /// The table of members, which talus-preprocess writes.
  std::filesystem::path members() const { return out / "members.h5"; }
  std::filesystem::path domain(std::int64_t member) const;  ///< the domain of a member that has one of its own
  /// The folder of the members' own domains, and of whole runs that are kept.
  std::filesystem::path folder() const { return out / "members"; }
  std::filesystem::path counts() const { return out / "counts.h5"; }  ///< the counts of all members
  std::filesystem::path counts(const MemberRange& part) const;        ///< the counts of a part
  /// What a computation of a part that was stopped has finished.
  std::filesystem::path unfinished(const MemberRange& part) const;
  std::filesystem::path run_folder(std::int64_t member) const;  ///< the folder of a member whose whole run is kept
  /// The files of counts in the folder: counts.h5, else those of parts in the order of their members.
  std::vector<std::filesystem::path> found_counts() const;
};

namespace h5 {
class File;
}

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

/// The key by which the released thickness is scaled; the solver scales the points of a domain by it.
inline constexpr const char* thickness_factor_key = "preprocess.thickness_factor";

struct MemberColumn {
  std::string key;                 ///< with its tables: "solve.base.friction_angle_deg"
  std::vector<double> values;      ///< [members]; of words: their places in `words`
  std::vector<std::string> words;  ///< that the key takes; empty: it is a number
};

/// What members that are slides of their own over one elevation model have besides.
struct SlideTable {
  MapGrid lattice;                   ///< holds the windows of all; never a raster as a whole
  std::vector<CellWindow> windows;   ///< [members]: the cells of its domain among those of the lattice
  std::vector<std::string> domains;  ///< [members]: domain.id of its domain
  Raster ground;                     ///< the model over all windows, coarse, for pages: elevation [m]
};

struct MemberTable {
  std::string design;            ///< as the recipe names it
  std::int64_t seed = 0;         ///< of the design
  std::int64_t count = 0;        ///< number of members
  std::int64_t sample_size = 0;  ///< design = "sensitivity": N of the N (d + 2) members; otherwise 0
  std::vector<MemberColumn> columns;
  std::vector<std::uint8_t> own_domain;  ///< [members]: 1 where it has a domain of its own
  std::vector<std::string> names = {};   ///< [members]: of slides and of a budget; empty: they have none
  std::vector<std::string> rows = {};    ///< [members]: of a budget, the row of each; empty: it is no budget
  std::optional<SlideTable> slides = {};
  std::vector<MemberWords> failures = {};  ///< of members whose domain cannot be made, by member
  Facts provenance = {};                   ///< of what made the table

  /// What a member's recipe has in the place of the base's, "key=value" each, of the keys that begin with `prefix`.
  std::vector<std::string> values_of(std::int64_t member, const std::string& prefix) const;
  std::string name_of(std::int64_t member) const;  ///< what a member is called: its name, else "member 12"
  /// What members are called, those beyond `most` by their number: "north, south and 3 more".
  std::string names_of(const std::vector<std::int64_t>& members, std::size_t most) const;
  /// Why a member's domain cannot be made, null where it can.
  const MemberWords* failure_of(std::int64_t member) const;
  const MemberColumn* find(const std::string& key) const;  ///< the column of a key, null where it does not vary
};

/// Names of facts of a table of members.
inline constexpr const char* recipe_of_members = "recipe.ensemble";  ///< mark of the table that drew them
inline constexpr const char* recipe_of_slides = "recipe.slides";     ///< and of the one that lists slides
inline constexpr const char* prior_of_members = "prior";  ///< where their distributions come from, where one is given
inline constexpr const char* elevation_error_of_members = "elevation_error";  ///< in words, where there is one
inline constexpr const char* base_domain_id = "domain.id";                    ///< of the domain that they differ from

/// Writes the table, sealed and aside. Throws DataError.
void write_member_table(const std::filesystem::path& file, const MemberTable& table);

/// Reads it back. Throws DataError: missing, damaged, not a table of members, or holding what cannot be.
MemberTable read_member_table(const std::filesystem::path& file);

/// Refuses (DataError) a table in `file` that another [ensemble] or [slides] made.
void judge_members(const recipe::Recipe& recipe, const std::filesystem::path& file, const MemberTable& table);

}  // namespace talus
