// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"
#include "groom/groom.h"
#include "lod/simplification.h"

namespace pelage {

class Workers;

/// What the strands of a groom are like at rest, for a character of scale 1: means over the strands of the
/// smallest ids, some hundreds that stand all over the skin. Does not depend on how the groom is divided into
/// leaves. `rest`: null for a groom on no skin.
CoatStats coat_stats(const Groom& groom, const LimitSurface* rest, const Workers& workers);

}  // namespace pelage
