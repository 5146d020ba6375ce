// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "geom/mesh.h"
#include "world/scene_schema.h"

namespace pelage {

/// Charges what reading the mesh of a skin takes; throws Error (kMemory) when there is no room for it.
MemoryCharge reserve_reading(const std::string& name, const SkinParams& params, const Job& job);

/// Charges the cage and what making a skin of `cage` takes at most; throws Error (kMemory) when there is no
/// room for it. Warns of a mesh with so many faces that subdividing it is hardly meant.
MemoryCharge reserve_skin(const std::string& name, const SkinParams& params, const ControlMesh& cage,
                          const Job& job);

}  // namespace pelage
