// SPDX-License-Identifier: Apache-2.0
#include "scene/yaml_text.h"

#include <algorithm>
#include <filesystem>

namespace pelage {
namespace {

bool is_plain(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '+' || c == '.' || c == '/';
  });
}

std::string scalar_text(const std::string& text, bool quoted) {
  // A leading '-' or '.' is plain in numbers and paths; a lone '-' is a list.
  if (!quoted && is_plain(text) && text != "-") return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

void make_absolute(Value& file) {
  if (!file.is_scalar() || file.text().empty()) return;
  std::filesystem::path path = file.text();
  if (path.is_relative() && file.position().line > 0)
    path = std::filesystem::path(file.position().file).parent_path() / path;
  path = std::filesystem::absolute(path).lexically_normal();
  file = Value::scalar(file.position(), path.string(), true);
}

}  // namespace

void make_paths_absolute(Value& block, const SchemaInfo& schema) {
  for (Value::Entry& entry : block.entries()) {
    const KeyInfo* key = schema.find(entry.key);
    if (!key) continue;
    if (key->type == "file") make_absolute(entry.value);
    key->visit_blocks(entry.value, make_paths_absolute);
  }
}

std::string yaml_text(const Value& value) {
  if (value.is_null()) return "null";
  if (value.is_scalar()) return scalar_text(value.text(), value.quoted());
  std::string text;
  if (value.is_list()) {
    for (const Value& item : value.items()) text += (text.empty() ? "" : ", ") + yaml_text(item);
    return "[" + text + "]";
  }
  for (const Value::Entry& entry : value.entries())
    text += (text.empty() ? "" : ", ") + scalar_text(entry.key, false) + ": " + yaml_text(entry.value);
  return "{" + text + "}";
}

}  // namespace pelage
