// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/value_readers.h"
#include "geom/io/strand_file.h"

namespace pelage {

/// read_strands() of a file that a scene names. Errors say where it was named, and of which file they are.
StrandFile read_named_strands(const AssetPath& file, const StrandReadOptions& options);

}  // namespace pelage
