// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/escaped_xml.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>

#include <memory>

namespace talus {

std::string escaped_xml(const std::string& text) {
  // A text cut at a null character is shorter, and harms nothing.
  const std::unique_ptr<char, decltype(&VSIFree)> escaped(CPLEscapeString(text.c_str(), -1, CPLES_XML), VSIFree);
  return escaped.get();
}

}  // namespace talus
