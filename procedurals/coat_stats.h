// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"
#include "groom/groom.h"
#include "lod/simplification.h"

namespace pelage {

class Workers;

/// Average properties of a groom's strands at rest, for a character of scale 1: means over some hundred
/// strands with the smallest ids, which are spread over the whole skin. Independent of how the groom is
/// divided into leaves. `rest`: null for a groom without a skin.
CoatStats coat_stats(const Groom& groom, const LimitSurface* rest, const Workers& workers);

}  // namespace pelage
