// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <opensubdiv/far/topologyRefiner.h>

#include "geom/limit_surface.h"

// For the sources of geom and their tests only, because it exposes types of OpenSubdiv.

namespace pelage {

/// Checks that a cage has a limit surface (SurfaceTopology::create). If it has none, throws Error (kInput)
/// with every reason. `source` names the cage in messages.
void check_cage(const ControlMesh& mesh, SubdivisionScheme scheme, const std::string& source);

/// Returns the unrefined topology of a cage that check_cage() has accepted. Throws Error (kInput) when
/// OpenSubdiv rejects the cage. Does not pass holes to OpenSubdiv, because holes do not interrupt the surface
/// around them.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const ControlMesh& mesh,
                                                               SubdivisionScheme scheme,
                                                               BoundaryRule boundary,
                                                               const std::string& source);

}  // namespace pelage
