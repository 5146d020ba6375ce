// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Grows the strands of a groom with ids below `count` at rest, for a character of scale 1. Calls `visit`
/// with a batch and an index for each strand, in the order of the ids. Sums in this order do not depend on
/// how the groom is divided into leaves. The strands are spread over the whole skin. `rest`: null for a groom
/// without a skin.
void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&, size_t strand)>& visit);

}  // namespace pelage
