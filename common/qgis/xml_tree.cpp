// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/xml_tree.hpp"

#include <cpl_conv.h>
#include <cpl_minixml.h>

namespace talus {

namespace {

/// XML has no way to write most control characters; names in files may hold them.
std::string writable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') c = ' ';
  return text;
}

}  // namespace

XmlElement XmlElement::add(const char* name, Attributes attributes) {
  XmlElement child(CPLCreateXMLNode(node_, CXT_Element, name));
  for (const auto& [key, value] : attributes) child.set(key, value);
  return child;
}

XmlElement XmlElement::add_text(const char* name, const std::string& text) {
  return XmlElement(CPLCreateXMLElementAndValue(node_, name, writable(text).c_str()));
}

void XmlElement::set(const char* key, const std::string& value) {
  CPLAddXMLAttributeAndValue(node_, key, writable(value).c_str());
}

XmlDocument::XmlDocument(const char* root, XmlElement::Attributes attributes)
    : tree_(CPLCreateXMLNode(nullptr, CXT_Element, root)) {
  for (const auto& [key, value] : attributes) this->root().set(key, value);
}

std::string XmlDocument::text(const std::string& doctype) const {
  const std::unique_ptr<char, void (*)(void*)> text(CPLSerializeXMLTree(tree_.get()), CPLFree);
  return doctype + "\n" + text.get();
}

void XmlDocument::Destroy::operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }

}  // namespace talus
