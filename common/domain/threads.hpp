// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many threads libraries may take.
#pragma once

namespace talus {

/// From now on oneTBB (which OpenVDB and the solver's loops run on), OpenMP and OpenBLAS, where they are loaded, take
/// at most so many threads, the calling one included. To be called before their first work; 1: they start none.
void limit_threads_of_libraries(int threads);

}  // namespace talus
