// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/hash.h"
#include "base/value.h"

namespace pelage {

/// Returns the hash of a document to which includes and overrides have been applied. The hash depends on all
/// keys and values, on their order, and on whether texts are quoted. It does not depend on positions,
/// comments or formatting.
ContentHash document_hash(const Value& document);

}  // namespace pelage
