// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs side by side: the members of an ensemble.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// This function calls run(place, device) for each place from 0 to count - 1, in that order, on a thread for each
/// device, whose loops stay on that thread. No more are begun once the process is interrupted or a call has thrown;
/// what the first threw it throws when all threads have ended.
void side_by_side(std::size_t count, const std::vector<AnyDevice>& devices,
                  const std::function<void(std::size_t place, const AnyDevice& device)>& run);

}  // namespace talus::solver
