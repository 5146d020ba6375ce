// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"

namespace pelage {

/// A node of a scene document with its position, independent of the parser that made it.
///
/// Scalars keep their text. The schema of the key decides the meaning of the text: `strands: 1e5` is a
/// number, `name: 007` is a text. Maps keep the order of the file; their keys are unique.
class Value {
 public:
  enum class Kind { kNull, kScalar, kList, kMap };
  struct Entry;

  Value() = default;
  static Value scalar(SourcePosition position, std::string text, bool quoted = false);
  static Value list(SourcePosition position, std::vector<Value> items);
  static Value map(SourcePosition position, std::vector<Entry> entries);

  Kind kind() const { return kind_; }
  bool is_null() const { return kind_ == Kind::kNull; }
  bool is_scalar() const { return kind_ == Kind::kScalar; }
  bool is_list() const { return kind_ == Kind::kList; }
  bool is_map() const { return kind_ == Kind::kMap; }

  const SourcePosition& position() const { return position_; }
  void set_position(SourcePosition position) { position_ = std::move(position); }
  /// Text of a scalar, and whether it was quoted (then it is never a number, a boolean or null).
  const std::string& text() const { return text_; }
  bool quoted() const { return quoted_; }
  const std::vector<Value>& items() const { return items_; }
  std::vector<Value>& items() { return items_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::vector<Entry>& entries() { return entries_; }

  /// Value of a map's key, or nullptr.
  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
  /// "a number", "a list of 3" ... for messages of the form "expected X, got Y".
  std::string describe() const;

 private:
  Kind kind_ = Kind::kNull;
  SourcePosition position_;
  std::string text_;
  bool quoted_ = false;
  std::vector<Value> items_;
  std::vector<Entry> entries_;
};

struct Value::Entry {
  std::string key;
  SourcePosition key_position;
  Value value;
};

}  // namespace pelage
