// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"

namespace pelage {

/// Gives every key of a document its current name and adds a warning for every old one. A block that has a
/// key under both names adds a problem.
void rename_old_keys(Value& document, RenamedKeys& renamed, Problems& problems);

/// Follows the path of an override through a document whose keys have their current names.
class RenamedPath {
 public:
  RenamedPath(Value& document, RenamedKeys& renamed);
  /// The current name of a key of `block`. If `name` is an old name, adds a warning with the position
  /// `where`.
  std::string present_name(const Value& block, const std::string& name, const SourcePosition& where);
  /// Takes the next step of the path: from `block` to the `value` of one of its keys. `name`: the current
  /// name of this key.
  void enter(const Value& block, const std::string& name, Value& value);

 private:
  const SchemaInfo* table_of(const Value& block) const;

  RenamedKeys& renamed_;
  std::vector<std::pair<const Value*, const SchemaInfo*>> blocks_;  // next on the path
};

/// Merges `over` into `base`: entries of maps one by one, other values as a whole. `over` wins.
void merge_into(Value& base, Value over);

}  // namespace pelage
