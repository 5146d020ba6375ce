// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "base/value.h"

namespace pelage {

/// Limits for all files and overrides of one scene together. A reader subtracts its use, so the members are
/// what the scene may still use.
struct DocumentLimits {
  size_t bytes = size_t(2) << 20;  ///< total size of the texts
  size_t values = 200'000;         ///< count of scalars, lists, maps and keys
  int files = 64;                  ///< count of files, including the scene itself
};

/// Reads a text with one YAML document into a tree of values. Adds a problem for each anchor, alias, tag,
/// merge key, duplicate key and key that is not a scalar. Returns a null value for an empty document. Adds a
/// problem and returns nullopt if the text is not YAML, exceeds the limits, or is nested more than 64 levels
/// deep. Throws no exception because of the text.
///
/// `file`: file name for positions. If `fixed` is given, all values and problems have this position instead
/// (for text from the command line).
std::optional<Value> read_yaml(std::string text, const std::string& file,
                               const std::optional<SourcePosition>& fixed, DocumentLimits& limits,
                               Problems& problems);

}  // namespace pelage
