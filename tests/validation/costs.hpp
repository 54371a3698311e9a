// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the runs of the validation cost, in integers that do not depend on the machine: the book of what they have cost
// (costs.toml), and the bounds that follow from it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace talus::validation {

/// The cost of a run: steps, and Newton's and linear iterations where there are any, else 0.
struct Cost {
  long steps = 0, newton = 0, linear = 0;
};

/// The most that a number of the book may have become: 15 % and two more. The order of sums, which threads decide,
/// moves the iterations of a flow by a few per cent; a change that costs more than this should be known.
long cost_bound(long recorded);

/// Costs by run, "A1 quasi-static, quadratic, pcg".
using CostBook = std::map<std::string, Cost>;

/// The book in a file; empty where there is none. Throws std::runtime_error where it is not a table of three whole
/// numbers a run.
CostBook read_costs(const std::filesystem::path& file);

/// The text of the file.
std::string as_toml(const CostBook& book);

}  // namespace talus::validation
