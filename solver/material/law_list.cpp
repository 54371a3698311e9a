// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material/law_list.hpp"

#include <fmt/format.h>

namespace talus {

std::string shortest(double value) { return fmt::format("{}", value); }
std::string six_digits(double value) { return fmt::format("{:g}", value); }

}  // namespace talus
