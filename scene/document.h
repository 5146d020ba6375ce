// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value.h"

namespace pelage {

/// One `--set a.b.c=value` of the command line; the value is YAML.
struct Override {
  std::string key;
  std::string value;
};

/// Splits "a.b=value" at its first '='. Throws Error (kArguments) when there is none.
Override parse_override(const std::string& text);

/// Reads a scene file into a tree of values. Applies `include:` (a file or a list; maps are merged, the
/// including file wins), then the overrides, which take precedence over everything. Overrides address list
/// items by index. An item that is a map with one key can also be addressed by that key:
/// `grooms.under.operators.clump.amount`. Does not interpret the keys: schemas do that afterwards.
///
/// Reports all syntax mistakes, duplicate keys, anchors, aliases and tags together, each with
/// file:line:column. Depth, size and the number of included files are limited; include cycles are errors.
/// Throws Error (kInput).
Value load_document(const std::filesystem::path& path, const std::vector<Override>& overrides = {});

/// Support for renamed keys. A document may use an old name: the loader replaces it by the new name before
/// files are merged, so the including file and the overrides take precedence under either name. A file or an
/// override that gives a key under both names adds a problem.
struct RenamedKeys {
  const SchemaInfo& root;              ///< table of the whole document
  std::vector<Problem> warnings = {};  ///< one for every old name, with its position and the new name
};

/// The same for callers that validate the values afterwards and report all mistakes together. Adds mistakes
/// to `problems` instead of throwing, unless the scene file itself cannot be opened. Returns nullopt when a
/// file could not be read or is not YAML, because keys that are missing from such a document should not be
/// reported.
std::optional<Value> load_document(const std::filesystem::path& path, const std::vector<Override>& overrides,
                                   Problems& problems, RenamedKeys* renamed = nullptr);

/// Reads a document from memory; `name` replaces the file name in positions; includes are relative to the
/// current folder.
Value parse_document(const std::string& text, const std::string& name);

/// The manual of every key reachable from `root`, or of one table. Markdown when `markdown`, else plain text.
/// Throws Error (kArguments) with the nearest name when the section does not exist.
std::string manual_text(const SchemaInfo& root, const std::string& section = {}, bool markdown = false);

}  // namespace pelage
