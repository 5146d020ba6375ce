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

/// "a.b=value" split at its first '='. Throws Error (kArguments) when there is none.
Override parse_override(const std::string& text);

/// Reads a scene file into a tree of values: `include:` (a file or a list; maps are merged, the including
/// file wins), then the overrides (they win over all; list items are addressed by index, items that are maps
/// of one key also by that key: `grooms.under.operators.clump.amount`). Knows no type: what the keys mean is
/// for schemas.
///
/// Every syntax mistake, duplicate key, anchor, alias and tag is reported with file:line:column, together.
/// Depth, size and the number of included files are limited; include cycles are errors. Throws Error
/// (kInput).
Value load_document(const std::filesystem::path& path, const std::vector<Override>& overrides = {});

/// The keys that had other names before. A document may use the old name; the loader puts the new one in its
/// place, before the files are merged, so that the including file and the overrides win under either name. A
/// file that gives a key under both names is a problem.
struct RenamedKeys {
  const SchemaInfo& root;              ///< table of the whole document
  std::vector<Problem> warnings = {};  ///< one for every old name, with its place and the new name
};

/// The same for callers that go on to check the values and report all mistakes together: problems are added,
/// not thrown, unless the scene file itself cannot be opened. Nothing is returned when some file could not be
/// read or is not YAML: what such a document lacks means nothing.
std::optional<Value> load_document(const std::filesystem::path& path, const std::vector<Override>& overrides,
                                   Problems& problems, RenamedKeys* renamed = nullptr);

/// The same from memory; `name` stands for the file in positions, includes are relative to the current
/// folder.
Value parse_document(const std::string& text, const std::string& name);

/// The manual of every key reachable from `root`, or of one table. Throws Error (kArguments) with the nearest
/// name when there is no such section. Markdown when `markdown`, else plain text.
std::string manual_text(const SchemaInfo& root, const std::string& section = {}, bool markdown = false);

}  // namespace pelage
