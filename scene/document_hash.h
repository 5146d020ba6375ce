// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/hash.h"
#include "base/value.h"

namespace pelage {

/// Hash of a document after includes and overrides: keys and values in their order, without positions,
/// comments and formatting.
ContentHash document_hash(const Value& document);

}  // namespace pelage
