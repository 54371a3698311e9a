// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The flow over time in a project of QGIS: a layer for every frame, which the Temporal Controller shows in turn.
#pragma once

#include <string>
#include <vector>

#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// `seconds` after `start` ("1903-04-29 04:10:00", UTC), to a millisecond: "1903-04-29T04:11:40.500Z".
std::string instant_after(const std::string& start, double seconds);

/// Which of `count` frames are shown, `most` of them at most: all, or evenly chosen with the first and the last.
std::vector<std::size_t> shown_frames(std::size_t count, std::size_t most);

/// Thickness at each frame, from maps/results.nc, in the classes of the deposit; not shown at first. Each lasts until
/// the next begins. Without layers where the run has fewer than two frames.
ProjectGroup flow_group(const Run& run, const Options& options);

}  // namespace talus::postprocess
