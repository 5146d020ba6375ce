// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"

namespace pelage {

/// Puts the fields of `regions:` in the places of their names, `{region: NAME}`, everywhere in the document
/// of a scene. A region is a field and thus means the same on every skin; it may use other regions.
///
/// Adds a problem for each unknown name, with the nearest known one, and one for regions that use each other
/// in a circle, are nested too deeply or become too large. It then leaves an empty name, which fields reject
/// silently.
void expand_regions(Value& document, Problems& problems);

}  // namespace pelage
