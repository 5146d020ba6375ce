// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value.h"

namespace pelage {

/// One option `--set key=value` of the command line, or a value that a host sets. The key is a path "a.b.c".
struct Override {
  std::string key;
  std::string value;                          ///< as YAML
  std::optional<Value> given = std::nullopt;  ///< replaces `value`; null removes the key
};

/// Splits "a.b=value" at the first '='. Throws Error (kArguments) when there is no '=' or no key before it.
Override parse_override(const std::string& text);

/// Reads a scene file into a tree of values. Merges the files of the key `include` (a file or a list of
/// files) into the document: maps are merged key by key, and the values of the including file take
/// precedence. Then applies the overrides, which take precedence over all files. The key of an override
/// addresses an item of a list by its index, from 0. If the item is a map with one key, this key can be used
/// instead of the index: `grooms.under.operators.clump.amount`. Does not interpret keys and values; schemas
/// do so afterwards.
///
/// Throws Error (kInput) with all mistakes together, each with file:line:column. Mistakes are malformed YAML,
/// duplicate keys, anchors, aliases, tags, and a file that includes itself. The depth of nesting, the total
/// size and the number of files are limited (DocumentLimits).
Value load_document(const std::filesystem::path& path, const std::vector<Override>& overrides = {});

/// Support for renamed keys. A document may use an old name of a key. The loader replaces old names by
/// current names before it merges files, so the precedence of files and overrides does not depend on which
/// name they use. It is an error if one file or one override uses both names of a key.
struct RenamedKeys {
  const SchemaInfo& root;              ///< table of the whole document
  std::vector<Problem> warnings = {};  ///< one per use of an old name, with its position and the current name
};

/// Reads a scene file like the other load_document(), but adds mistakes to `problems` instead of throwing, so
/// that the caller can report them together with mistakes in the values. Throws Error (kInput) only if the
/// scene file itself cannot be opened. Returns nullopt when any file could not be read or is not YAML. The
/// caller then must not report missing keys, because the unreadable file may contain them.
std::optional<Value> load_document(const std::filesystem::path& path, const std::vector<Override>& overrides,
                                   Problems& problems, RenamedKeys* renamed = nullptr);

/// Completes a document that a host has made, like load_document() completes that of a file: replaces old
/// names of keys, merges included files, and applies the overrides. Relative names of files start at the
/// current folder. Returns nullopt when an included file could not be read or is not YAML.
std::optional<Value> complete_document(Value document, const std::vector<Override>& overrides,
                                       Problems& problems, RenamedKeys* renamed = nullptr);

/// Reads a document from a text. `name` is used as the file name in positions. Included files are relative to
/// the folder of `name`, which is the current folder if `name` contains no folder. Throws Error (kInput) with
/// all mistakes.
Value parse_document(const std::string& text, const std::string& name);

/// Returns the manual of all schemas that can be reached from `root`. If `section` is not empty, returns only
/// the manual of the schema of that name. The text is Markdown if `markdown` is true, else plain text. Throws
/// Error (kArguments) with the nearest name when there is no such section.
std::string manual_text(const SchemaInfo& root, const std::string& section = {}, bool markdown = false);

}  // namespace pelage
