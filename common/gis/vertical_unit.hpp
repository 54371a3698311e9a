// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Units that heights come in.
#pragma once

#include <optional>
#include <string>

namespace talus {

/// Metres in one of a unit by the names that files and people give it: "m", "metre", "Meters", "ft", "US survey foot",
/// "cm". Empty names and those of other quantities ("deg", "kPa", "m/s") count as 1; nullopt for a word that may well
/// be a length but is not known ("fathom").
std::optional<double> metres_in(const std::string& unit);

}  // namespace talus
