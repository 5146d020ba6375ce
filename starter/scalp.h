// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/vector.h"
#include "geom/mesh.h"

namespace pelage {

/// Where hair grows on a human head: above a slanted plane from the nape to the hairline of the forehead.
/// Coordinates are signed, so that `up` increases to the top and `forward` to the face.
struct Scalp {
  float slope = 0;   ///< of the plane: rise in `up` per unit of `forward`
  float height = 0;  ///< of the plane where `forward` is 0
  float area = 0;    ///< of the cage above the plane
};

/// Guesses the scalp of a head, a bust or a standing person. The head is what lies above the narrowest place
/// below its widest one. `box`: of the vertices that faces use. `up`, `forward`: directions of axes.
Scalp guess_scalp(const ControlMesh& mesh, const Box3f& box, const V3f& up, const V3f& forward);

}  // namespace pelage
