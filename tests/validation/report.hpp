// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of all rows, for people and as JSON.
#pragma once

#include "tests/validation/bench.hpp"

namespace talus::validation {

/// When and with what the rows were made.
struct Sitting {
  std::string commit, date;  // 1a2b3c4d5, "-dirty" behind it where the tree has changes; 2026-11-22
  std::string on;            // auto | cpu | gpu
  bool complete = false, coarse = false;
  std::vector<std::string> cases;  // that were asked for
};

/// How many rows there are of each kind.
struct Counts {
  long judged = 0, missed = 0;  // of the judged ones: beyond their tolerance, or without a result
  long noted = 0, lost = 0;     // of the noted ones: without a result
};
Counts count(const std::vector<Row>& rows);

/// Columns padded; below the table what went wrong in runs, and how many rows are judged, failed and noted.
std::string as_table(const std::vector<Row>& rows);

/// An object of the sitting and the list `rows`; a number that is not known is null. A noted row has `judged` false,
/// and neither error, tolerance nor `pass`.
std::string as_json(const Sitting& sitting, const std::vector<Row>& rows);

}  // namespace talus::validation
