// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Memory in pages of 2 MB where much is asked for at once. Lists of millions of points are written once, and to be
// given memory in pages of 4 kB takes longer than writing it. Programs that link this get it by `new` too.
#pragma once

#include <cstddef>

namespace talus {

/// Uninitialised memory [bytes], aligned to 64, for std::free(); null where there is not enough.
void* memory_in_large_pages(std::size_t bytes) noexcept;

}  // namespace talus
