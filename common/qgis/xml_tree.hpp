// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// An XML document being made. GDAL's tree stands behind it.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

struct CPLXMLNode;

namespace talus {

/// One element; the document owns them all.
class XmlElement {
 public:
  using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

  explicit XmlElement(CPLXMLNode* node) : node_(node) {}
  /// A new element inside this one, behind those it has.
  XmlElement add(const char* name, Attributes attributes = {});
  /// Adds an element that holds text, and returns it.
  XmlElement add_text(const char* name, const std::string& text);
  /// Sets an attribute.
  void set(const char* key, const std::string& value);

 private:
  CPLXMLNode* node_;
};

/// A document that owns its elements.
class XmlDocument {
 public:
  XmlDocument(const char* root, XmlElement::Attributes attributes);
  /// The outermost element.
  XmlElement root() const { return XmlElement(tree_.get()); }
  /// The document, with `doctype` above it.
  std::string text(const std::string& doctype) const;

 private:
  struct Destroy {
    void operator()(CPLXMLNode* node) const;
  };
  std::unique_ptr<CPLXMLNode, Destroy> tree_;
};

inline constexpr const char* qgis_doctype = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>";

}  // namespace talus
