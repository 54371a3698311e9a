// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and points that talus-preprocess read from vector files ([[preprocess.place]]), for sections, inflows and
// gauges of [solve], which ask for them by name.
#pragma once

#include <optional>
#include <string>

#include "common/map/polygon.hpp"

namespace talus {

/// A line or a point of the map under a name.
struct DomainPlace {
  std::string place;  ///< name of the [[preprocess.place]] that it is of
  std::string name;   ///< its own there
  MapLine points;     ///< map coordinates [m]; one: a point

  bool operator==(const DomainPlace&) const = default;
  bool is_line() const { return points.size() > 1; }  ///< whether it is a line
};

/// Whether a name is fit for the names of columns: letters, digits, - and _.
bool is_plain_name(const std::string& name);

/// A name made fit: each run of other letters becomes one -, none at its ends. Empty where nothing is left.
std::string plain_name(const std::string& name);

/// Points as text, "x,y x,y", to the last bit.
std::string text_of_points(const MapLine& points);

/// The points of such a text; none where it is none.
std::optional<MapLine> points_in(const std::string& text);

}  // namespace talus
