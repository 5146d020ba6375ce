// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "geom/limit_surface.h"
#include "groom/groom.h"

namespace pelage {

class Workers;

/// Grows the strands of a groom whose ids are less than `count` at rest, for a character of scale 1, and
/// hands them out, some at a time, in an order that does not change. They stand all over the skin and do not
/// depend on how the groom is divided into leaves. `rest`: null for a groom on no skin.
void visit_coat_sample(const Groom& groom, const LimitSurface* rest, uint64_t count, const Workers& workers,
                       const std::function<void(const Strands&)>& visit);

}  // namespace pelage
