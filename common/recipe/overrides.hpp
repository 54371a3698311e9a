// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a recipe that are given on the command line: --set key=value.
#pragma once

#include <string_view>

namespace talus::recipe {

/// What messages put in front of "key=value" in the place of file, line and column.
inline constexpr std::string_view set_mark = "--set ";

}  // namespace talus::recipe
