// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Text inside XML and HTML.
#pragma once

#include <string>

namespace talus {

/// Text as it may stand in an element or a quoted attribute of XML or HTML: &, <, > and " as entities. Control
/// characters other than tabs and line ends are left out, since XML has no place for them. GDAL's rule.
std::string escaped_xml(const std::string& text);

}  // namespace talus
