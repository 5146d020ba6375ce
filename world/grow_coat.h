// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/job.h"
#include "geom/strands.h"
#include "world/compose.h"

namespace pelage {

/// Grows all strands of a coat of a composed world into one batch, ordered by id, with all motion keys.
/// `coat`: the name of a groom ("under"), for this groom on all characters, or of a coat ("rat.under"), for
/// one character. Level of detail applies as the world has it; positions are those of the world, see
/// RenderScene::origin.
///
/// Throws Error: kArguments with the nearest name if there is no such coat, or if coats that differ in basis
/// or motion keys would have to share a batch; kMemory if the strands do not fit `render.memory` twice;
/// kStopped when the job is stopped.
Strands grow_coat(const World& world, const std::string& coat, const Job& job);

}  // namespace pelage
