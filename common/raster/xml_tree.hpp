// An XML document being made, on GDAL's tree. For the sources of this folder alone.
#pragma once

#include <cpl_conv.h>
#include <cpl_minixml.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

namespace talus {

/// One element; the document owns them all.
class XmlElement {
 public:
  explicit XmlElement(CPLXMLNode* node) : node_(node) {}

  using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

  /// A new element inside this one, behind those it has.
  XmlElement add(const char* name, Attributes attributes = {}) {
    XmlElement child(CPLCreateXMLNode(node_, CXT_Element, name));
    for (const auto& [key, value] : attributes) child.set(key, value);
    return child;
  }
  XmlElement add_text(const char* name, const std::string& text) {
    return XmlElement(CPLCreateXMLElementAndValue(node_, name, text.c_str()));
  }
  void set(const char* key, const std::string& value) { CPLAddXMLAttributeAndValue(node_, key, value.c_str()); }
  CPLXMLNode* node() const { return node_; }

 private:
  CPLXMLNode* node_;
};

class XmlDocument {
 public:
  XmlDocument(const char* root, XmlElement::Attributes attributes) : tree_(CPLCreateXMLNode(nullptr, CXT_Element, root)) {
    for (const auto& [key, value] : attributes) this->root().set(key, value);
  }
  XmlElement root() const { return XmlElement(tree_.get()); }
  /// The document, with `doctype` above it.
  std::string text(const std::string& doctype) const {
    const std::unique_ptr<char, void (*)(void*)> text(CPLSerializeXMLTree(tree_.get()), CPLFree);
    return doctype + "\n" + text.get();
  }

 private:
  struct Destroy {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
  };
  std::unique_ptr<CPLXMLNode, Destroy> tree_;
};

inline constexpr const char* qgis_doctype = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>";

}  // namespace talus
