// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"
#include "scene/yaml_reader.h"

namespace pelage {

/// Puts the value of an override into a document, replacing what stood there and making the blocks that lead
/// to it, unless one of a similar name is there. Items of lists are addressed by index (from 0), by the only
/// key of an item, or by the `name:` in the block under that key. Positions of what it adds say "--set
/// a.b.c".
void apply_override(const Override& override, Value& document, DocumentLimits& limits, Problems& problems);

}  // namespace pelage
