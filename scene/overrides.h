// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {

/// Sets the value of an override in a document, replacing the existing value and creating the blocks that
/// lead to it, unless one of a similar name exists. Items of lists are addressed by index (from 0), by the
/// only key of an item, or by the `name:` in the block under that key. Positions of what it adds are "--set
/// a.b.c". With `renamed`, the document has present names, and keys on the path may have old ones.
void apply_override(const Override& override, Value& document, DocumentLimits& limits, Problems& problems,
                    RenamedKeys* renamed = nullptr);

}  // namespace pelage
