// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "base/value.h"

namespace pelage {

/// Remaining allowance of one scene, over all its files and overrides. Readers subtract what they use.
struct DocumentLimits {
  size_t bytes = size_t(2) << 20;
  size_t values = 100'000;
  int files = 64;
};

/// Reads one YAML document into values, without expanding anything: anchors, aliases, tags, merge keys,
/// duplicate keys and keys that are not names are problems, as is nesting beyond 64 levels. An empty document
/// is a null value; text that is not YAML adds a problem and returns nothing. Never throws because of the
/// text.
///
/// `file`: file name in positions; with `fixed`, every value has this position instead (for text from the
/// command line).
std::optional<Value> read_yaml(std::string text, const std::string& file,
                               const std::optional<SourcePosition>& fixed, DocumentLimits& limits,
                               Problems& problems);

}  // namespace pelage
