// SPDX-License-Identifier: Apache-2.0
#include "scene/document_hash.h"

#include <string>

namespace pelage {

namespace {

// Every text is preceded by its length, every list and map by its size, so that different documents give
// different texts.
void append(const std::string& text, std::string& out) { out += std::to_string(text.size()) + ":" + text; }

void append(const Value& value, std::string& out) {
  switch (value.kind()) {
    case Value::Kind::kNull:
      out += "n";
      return;
    case Value::Kind::kScalar:
      out += value.quoted() ? "q" : "s";
      append(value.text(), out);
      return;
    case Value::Kind::kList:
      out += "l" + std::to_string(value.items().size()) + ":";
      for (const Value& item : value.items()) append(item, out);
      return;
    case Value::Kind::kMap:
      out += "m" + std::to_string(value.entries().size()) + ":";
      for (const Value::Entry& entry : value.entries()) {
        append(entry.key, out);
        append(entry.value, out);
      }
      return;
  }
}

}  // namespace

ContentHash document_hash(const Value& document) {
  std::string text;
  append(document, text);
  return content_hash(std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace pelage
