// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the picture of a search for the factor of safety says in place of a run's numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "postprocess/picture/map_picture.hpp"

namespace talus::postprocess {

/// Whether the picture is that of a search: the mass that fails first is drawn in the deposit's place.
bool shows_search(const PictureInput& input);

/// Factor and mass in a line, for below the title.
std::string search_line(const PictureInput& input);

/// The same for the column beside the map: words and value; what the search did not find is left out.
std::vector<std::pair<std::string, std::string>> search_numbers(const PictureInput& input);

}  // namespace talus::postprocess
