// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "geom/mesh.h"
#include "world/scene_schema.h"

namespace pelage {

/// Charges the memory for reading the mesh of a skin; throws Error (kMemory) when it does not fit.
MemoryCharge reserve_reading(const std::string& name, const SkinParams& params, const Job& job);

/// Charges the cage and the max memory for making a skin of `cage`; throws Error (kMemory) when it does not
/// fit. Warns if the mesh has so many faces that it was probably not made for subdivision.
MemoryCharge reserve_skin(const std::string& name, const SkinParams& params, const ControlMesh& cage,
                          const Job& job);

}  // namespace pelage
