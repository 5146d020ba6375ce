// SPDX-License-Identifier: Apache-2.0
#include "base/value.h"

#include "base/nearest_name.h"

namespace pelage {

Value Value::scalar(SourcePosition position, std::string text, bool quoted) {
  Value value;
  value.kind_ = Kind::kScalar;
  value.position_ = std::move(position);
  value.text_ = std::move(text);
  value.quoted_ = quoted;
  return value;
}

Value Value::host(SourcePosition position, std::shared_ptr<const HostData> data) {
  Value value = scalar(std::move(position), data->name(), true);
  value.data_ = std::move(data);
  return value;
}

Value Value::list(SourcePosition position, std::vector<Value> items) {
  Value value;
  value.kind_ = Kind::kList;
  value.position_ = std::move(position);
  value.items_ = std::move(items);
  return value;
}

Value Value::map(SourcePosition position, std::vector<Entry> entries) {
  Value value;
  value.kind_ = Kind::kMap;
  value.position_ = std::move(position);
  value.entries_ = std::move(entries);
  return value;
}

const Value* Value::find(std::string_view key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

Value* Value::find(std::string_view key) {
  return const_cast<Value*>(static_cast<const Value*>(this)->find(key));
}

std::string Value::describe() const {
  switch (kind_) {
    case Kind::kNull:
      return "nothing";
    case Kind::kScalar:
      return quote(text_);
    case Kind::kList:
      return "a list of " + std::to_string(items_.size());
    case Kind::kMap:
      return "a block of " + std::to_string(entries_.size()) + (entries_.size() == 1 ? " key" : " keys");
  }
  return {};
}

}  // namespace pelage
