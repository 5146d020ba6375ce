// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geom/strands.h"

namespace pelage {

/// One batch with the strands of all, in order of their ids (ties: in order of the batches). The batches have
/// one basis and one number of motion keys. Attributes that every batch has are kept, in the widest class
/// that any batch has them in; roots and root uvs are kept when every batch that is not empty has them.
Strands merge(std::span<const Strands> batches);

}  // namespace pelage
