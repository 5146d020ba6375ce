// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"

namespace pelage {

/// Replaces every old name of a key in a document by its current name, and adds a warning for it. If a block
/// contains both names of a key, adds a problem and removes the entry with the old name.
void rename_old_keys(Value& document, RenamedKeys& renamed, Problems& problems);

/// Follows the path of an override through a document, and translates old names of keys in the path. The keys
/// of the document must have their current names.
class RenamedPath {
 public:
  RenamedPath(Value& document, RenamedKeys& renamed);
  /// Returns the current name of a key of `block`. If `name` is an old name, adds a warning with the position
  /// `where`; otherwise returns `name`.
  std::string present_name(const Value& block, const std::string& name, const SourcePosition& where);
  /// Moves one step along the path, from `block` to `value`, which is the value of the key `name` of this
  /// block. `name` must be the current name.
  void enter(const Value& block, const std::string& name, Value& value);

 private:
  const SchemaInfo* table_of(const Value& block) const;

  RenamedKeys& renamed_;
  std::vector<std::pair<const Value*, const SchemaInfo*>> blocks_;  // possible next blocks, with tables
};

/// Merges `over` into `base`. If both are maps, merges them key by key; keys of only one map are kept.
/// Otherwise replaces `base` by `over`.
void merge_into(Value& base, Value over);

}  // namespace pelage
