// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"
#include "groom/groom.h"
#include "lod/simplification.h"

namespace pelage {

class Workers;

/// Returns average properties of a groom's strands at rest, for a character of scale 1. Width and length are
/// means over the strands with ids below 256, which are spread over the whole skin. The result does not
/// depend on how the groom is divided into leaves. `rest`: the skin at rest; null for a groom without a skin.
CoatStats coat_stats(const Groom& groom, const LimitSurface* rest, const Workers& workers);

}  // namespace pelage
