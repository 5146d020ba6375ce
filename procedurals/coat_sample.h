// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Grows the strands of a groom whose ids are less than `count` at rest, for a character of scale 1, and
/// hands them out one by one, by their number in a batch, in the order of their ids: what sums over them in
/// this order sums the same however the groom is divided into leaves. They stand all over the skin. `rest`:
/// null for a groom on no skin.
void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&, size_t strand)>& visit);

}  // namespace pelage
