// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geom/limit_surface.h"
#include "image/field.h"

namespace pelage {

/// Returns the mean colour of a field on a skin at rest, for renderers that cannot evaluate the field: the
/// mean of the colours at the middles of the faces, weighted by the areas of the faces. Maps must have been
/// loaded. A skin without area has the mean of its faces.
Rgb mean_color(const Field& color, const LimitSurface& rest);

}  // namespace pelage
