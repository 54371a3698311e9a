// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an input must be to be opened at all, and texts that are read whole.
#pragma once

#include <filesystem>
#include <ios>
#include <optional>
#include <string>

namespace talus {

/// Throws DataError where `file` is a pipe, a socket or a device: inputs are read from several places, some of them
/// twice, and a pipe that nobody writes to would be waited for without end. What is missing, a file or a folder passes.
void require_plain(const std::filesystem::path& file);

/// Throws DataError where a reading of `stream` has failed: it ends what is read as the end of the file does.
void require_read(const std::ios& stream, const std::filesystem::path& file);

/// All bytes of a plain file that a stage wrote; none where it is not there. Throws DataError where it is there and
/// cannot be read, or is longer than 64 MB.
std::optional<std::string> text_if_there(const std::filesystem::path& file);

/// True where inputs may name places on a network (--network), in the calling thread's context.
bool network_allowed();

}  // namespace talus
