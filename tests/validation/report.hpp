// The table of all rows, for people and as JSON.
#pragma once

#include <string>
#include <vector>

#include "tests/validation/bench.hpp"

namespace talus::validation {

/// Columns padded; below the table what went wrong in runs without a result.
std::string as_table(const std::vector<Row>& rows);

/// A list of objects; a number that is not known is null.
std::string as_json(const std::vector<Row>& rows);

}  // namespace talus::validation
