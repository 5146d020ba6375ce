// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {

/// Sets the value of an override in a document: replaces the existing value, or creates the value and the
/// blocks that contain it. Does not create a block if a block of a similar name exists. An item of a list is
/// addressed by its index (from 0). An item that is a map with one key can also be addressed by this key, or
/// by the `name:` in the block under the key. Added values have the position "--set a.b.c". With `renamed`,
/// the document uses current names, and the path may use old names.
void apply_override(const Override& override, Value& document, DocumentLimits& limits, Problems& problems,
                    RenamedKeys* renamed = nullptr);

}  // namespace pelage
