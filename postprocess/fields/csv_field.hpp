// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Text in tables of comma-separated values.
#pragma once

#include <string>

namespace talus::postprocess {

/// A text as a field: quoted where it holds what separates fields, its line breaks made spaces.
std::string csv_field(std::string text);

}  // namespace talus::postprocess
