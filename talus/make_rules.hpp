// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The rules that a stage prints with --depends, read back.
#pragma once

#include <string>

#include "common/stage/depends.hpp"

namespace talus::command {

/// What make_rules() of common/stage/depends.hpp was made of: results and inputs of its first rule, without the names
/// that make has no way to write.
Dependencies read_make_rules(const std::string& text);

}  // namespace talus::command
