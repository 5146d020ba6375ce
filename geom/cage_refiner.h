// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <opensubdiv/far/topologyRefiner.h>

#include "geom/limit_surface.h"

// Only for sources of geom and its tests: exposes OpenSubdiv's types.

namespace pelage {

/// Throws Error (kInput) with `source` and every reason why a cage has no limit surface
/// (SurfaceTopology::create).
void check_cage(const ControlMesh& mesh, SubdivisionScheme scheme, const std::string& source);

/// The unrefined topology of a validated cage. Throws Error (kInput) with `source` when OpenSubdiv rejects
/// it. Holes are not passed on, because they do not interrupt the surface around them.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(const ControlMesh& mesh,
                                                               SubdivisionScheme scheme,
                                                               BoundaryRule boundary,
                                                               const std::string& source);

}  // namespace pelage
