// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is read as one text, and the lines of a text.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace talus {

/// All bytes of `file`, which may be a pipe. `refuse` is called with the reason, and must throw, where it is a folder
/// or longer than `most` bytes, and where it cannot be opened or read to its end.
std::string whole_text(const std::filesystem::path& file, std::uintmax_t most,
                       const std::function<void(const std::string& reason)>& refuse);

/// The lines of a text, without their ends; behind the last end there is none.
std::vector<std::string> lines_in(const std::string& text);

}  // namespace talus
