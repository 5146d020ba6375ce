// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/host_data.h"

namespace pelage {

/// A node of a scene document with its position. It does not depend on the parser that made it.
///
/// A scalar stores its text. The schema of its key decides the meaning of this text: `strands: 1e5` is a
/// number, `name: 007` is a text. A map has its entries in the order of the file, and its keys are unique.
class Value {
 public:
  enum class Kind { kNull, kScalar, kList, kMap };
  struct Entry;

  Value() = default;
  static Value scalar(SourcePosition position, std::string text, bool quoted = false);
  /// A scalar that names data of the host instead of a file. Its text is the name of the data.
  static Value host(SourcePosition position, std::shared_ptr<const HostData> data);
  static Value list(SourcePosition position, std::vector<Value> items);
  static Value map(SourcePosition position, std::vector<Entry> entries);

  Kind kind() const { return kind_; }
  bool is_null() const { return kind_ == Kind::kNull; }
  bool is_scalar() const { return kind_ == Kind::kScalar; }
  bool is_list() const { return kind_ == Kind::kList; }
  bool is_map() const { return kind_ == Kind::kMap; }

  const SourcePosition& position() const { return position_; }
  void set_position(SourcePosition position) { position_ = std::move(position); }
  /// Text of a scalar, without quotes.
  const std::string& text() const { return text_; }
  /// Whether the text of a scalar was in quotes. Such a text is never a number, a boolean or null.
  bool quoted() const { return quoted_; }
  /// The data that a scalar names; null for every other value.
  const std::shared_ptr<const HostData>& data() const { return data_; }
  const std::vector<Value>& items() const { return items_; }
  std::vector<Value>& items() { return items_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::vector<Entry>& entries() { return entries_; }

  /// Returns the value of a key of this map. Returns nullptr if the map has no such key or this is not a map.
  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
  /// Describes the value for messages of the form "expected X, got Y": the quoted text of a scalar, "a list
  /// of 3", "a block of 2 keys", or "nothing" for null.
  std::string describe() const;

 private:
  Kind kind_ = Kind::kNull;
  SourcePosition position_;
  std::string text_;
  bool quoted_ = false;
  std::shared_ptr<const HostData> data_;
  std::vector<Value> items_;
  std::vector<Entry> entries_;
};

struct Value::Entry {
  std::string key;
  SourcePosition key_position;
  Value value;
};

}  // namespace pelage
