// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Results stay in the output folder: nothing that lies there under a result's name leads out of it.
#pragma once

#include <filesystem>

namespace talus {

/// Throws DataError where a folder between the locked output folder and `path` is a link: what is written or removed
/// there would lie outside of it. The output folder itself may be one.
void require_inside(const std::filesystem::path& path);

/// Throws DataError where `file` cannot be a result: as require_inside(), or it is there and is no plain file but a
/// link (which is not followed), a folder, a pipe, a socket or a device. PendingFile asks it of its final name; the
/// name it writes under holds a random word, so that nothing lay there before.
void require_replaceable(const std::filesystem::path& file);

}  // namespace talus
