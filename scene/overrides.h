// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {

/// Sets the value that an override names: replaces the existing value, or creates the value and the blocks
/// that contain it. The value `null` removes an existing key or item. If a block is missing but a block with
/// a similar name exists, adds a problem instead of creating the block. The path addresses an item of a list
/// by its index (from 0). If the item is a map with one key, the path can also use this key, or the value of
/// `name` in the block under this key. The position of the new value is "--set a.b.c". If `renamed` is given,
/// the document must use current names of keys, but the path may use old names.
void apply_override(const Override& override, Value& document, DocumentLimits& limits, Problems& problems,
                    RenamedKeys* renamed = nullptr);

}  // namespace pelage
