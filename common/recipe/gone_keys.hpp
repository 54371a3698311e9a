// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The keys, tables and choices of earlier versions. A recipe that holds one is refused with the advice on it.
#pragma once

#include <string_view>

namespace talus::recipe {

/// The advice on a key or table that is gone, by its path ("solve.flip_fraction", "budget"), or on a word of a choice
/// that is gone ("solve.implicit.linear_solver=bicgstab"). Empty: no earlier version had it. The reader looks up only
/// the keys and words that no option declares.
std::string_view advice_on_gone(std::string_view place);

}  // namespace talus::recipe
