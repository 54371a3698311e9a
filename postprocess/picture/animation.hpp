// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The flow over time as a film, on request.
#pragma once

#include <filesystem>

#include "postprocess/picture/map_picture.hpp"

namespace talus::postprocess {

/// Refuse what cannot be made, before anything long begins: DataError where ffmpeg is not installed or the run holds
/// fewer than two frames.
void check_animation(Animation animation, const Run& run);

/// Write FOLDER/animation.mp4 or animation.gif (aside, renamed): the map of map_picture() with the flow at every frame
/// of the run and the time on it, some eight seconds long, and two more on the last frame. ffmpeg encodes it. Returns
/// the file. Throws DataError where ffmpeg fails (disk full).
std::filesystem::path write_animation(const std::filesystem::path& folder, const PictureInput& input,
                                      Animation animation);

/// Frames a second, so that all of a run's frames take about eight seconds: 2 to 25.
int film_rate(std::size_t frames);

}  // namespace talus::postprocess
