// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "geom/mesh.h"
#include "world/scene_schema.h"

namespace pelage {

/// Charges the memory for reading the mesh of skin `name`. Throws Error (kMemory) when this memory does not
/// fit the limit.
MemoryCharge reserve_reading(const std::string& name, const SkinParams& params, const Job& job);

/// Warns if `count` faces of a mesh were left out by merge_equal_faces(). `file`: for the message, in which
/// `position` comes first.
void warn_of_equal_faces(size_t count, const std::string& position, const std::string& file, const Job& job);

/// Charges the memory of `cage` and the max memory for making skin `name` from it. Throws Error (kMemory)
/// when this memory does not fit the limit. Warns if the skin is subdivided but has so many faces that it was
/// probably not modelled for subdivision.
MemoryCharge reserve_skin(const std::string& name, const SkinParams& params, const ControlMesh& cage,
                          const Job& job);

}  // namespace pelage
