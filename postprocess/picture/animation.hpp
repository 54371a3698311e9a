// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map over time as a film, encoded by ffmpeg.
#pragma once

#include <cstddef>

namespace talus::postprocess {

/// Frames per second for a film of about eight seconds: 2 to 25.
int film_rate(std::size_t frames);

}  // namespace talus::postprocess
