// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// XML files read back by tests.
#pragma once

#include <cpl_minixml.h>

#include <filesystem>
#include <memory>

namespace talus::test {

struct DestroyXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using XmlDocument = std::unique_ptr<CPLXMLNode, DestroyXml>;

inline XmlDocument parsed(const std::filesystem::path& file) { return XmlDocument(CPLParseXMLFile(file.c_str())); }

}  // namespace talus::test
