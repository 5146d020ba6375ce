// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/schema.h"
#include "base/value.h"

namespace pelage {

/// Makes the paths of files in a block of a document absolute, so that the block can be moved to another
/// file. `schema`: table that reads the block.
void make_paths_absolute(Value& block, const SchemaInfo& schema);

/// Returns a value of a document as YAML on one line: "{model: lambert, color: [0.5, 0.4, 0.3]}".
std::string yaml_text(const Value& value);

}  // namespace pelage
