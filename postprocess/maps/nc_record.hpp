// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a NetCDF file was given, held against what it has kept.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace talus::postprocess {

/// The record of the values and attributes that went into a NetCDF file. Libraries that overlook a failed allocation
/// may lose some without a word: where memory ran out, a history was once written that differed.
class NcRecord {
 public:
  /// The place of what is written: a group below the file's own (empty: the file's own) and a variable there (empty:
  /// the group itself). By name, for ids are others when the file is opened again.
  struct Place {
    std::string group, variable;
  };

  /// The values of a block of a variable, from `start` on, `count` along each dimension; both empty: a single value.
  void values(const Place& place, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
              std::span<const double> values);
  /// The texts of a variable of one dimension.
  void texts(const Place& place, const std::vector<std::string>& texts);
  /// An attribute that is text.
  void text(const Place& place, const std::string& name, const std::string& value);
  /// An attribute that is a list of numbers, whole ones too.
  void numbers(const Place& place, const std::string& name, const std::vector<double>& values);

  /// The first thing that a file of these bytes has kept otherwise than it was given, for a message; empty where there
  /// is none. The file is read as other programs read it.
  std::string difference(const std::string& bytes) const;

 private:
  class Opened;
  /// What is said of a difference; empty where there is none.
  using Check = std::function<std::string(const Opened&)>;

  std::vector<Check> checks_;
};

}  // namespace talus::postprocess
