// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Grows the strands of a groom whose ids are below `count`, at rest, for a character of scale 1. Then calls
/// `visit` for each strand, in the order of the ids, with a batch and the index of the strand in the batch.
/// Sums in this order do not depend on how the groom is divided into leaves. These strands are spread over
/// the whole skin. `rest`: the skin at rest; null for a groom without a skin.
void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&, size_t strand)>& visit);

}  // namespace pelage
