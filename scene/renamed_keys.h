// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/value.h"
#include "scene/document.h"

namespace pelage {

/// What to do where a block has a key under its old and its new name.
enum class BothNames {
  kRefuse,       ///< two keys of one file: a problem
  kOldNameWins,  ///< the old name is that of an override
};

/// Gives every key of a document its present name and adds a warning for every old one.
void rename_old_keys(Value& document, BothNames both, RenamedKeys& renamed, Problems& problems);

/// Moves `over` into `base`: entries of maps one by one, everything else as a whole. `over` wins.
void merge_into(Value& base, Value over);

}  // namespace pelage
