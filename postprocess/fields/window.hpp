// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of the map is shown.
#pragma once

#include <optional>

#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// A rectangle in map coordinates [m].
struct Window {
  double west = 0, south = 0, east = 0, north = 0;
  /// Extent from west to east [m].
  double width() const { return east - west; }
  /// Extent from south to north [m].
  double height() const { return north - south; }
};

/// Everything affected, released or surveyed, with a margin, inside the run's grid; not more slender than 5:8 where the
/// grid allows. The whole grid where nothing happened.
Window affected_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey);

/// The maps the picture draws (before, initial, deposit and peak thickness), cut to the window and two cells around it.
RunMaps cropped(const RunMaps& maps, const Window& window);

}  // namespace talus::postprocess
