// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/job.h"
#include "geom/limit_surface.h"
#include "groom/groom.h"
#include "lod/simplification.h"
#include "lod/width_fit.h"
#include "procedurals/detail/even_priorities.h"

namespace pelage {

/// Returns the distance from its origin beyond which a secondary ray sees only the fraction `share` of the
/// strands: twice the distance between these strands. `spacing`: distance between all strands.
float near_distance(float share, float spacing);

/// Returns the factors on the widths of the kept strands of a groom with which as many rays pass the kept
/// strands as pass all strands.
///
/// Pilot rays start on strands around a few roots, in directions away from the skin, and are tested against
/// the strands around these roots at rest. Only the part from near_distance() on counts, and only rays that
/// no strand blocks before. For each share and ray, find the smallest width factor at which a kept strand
/// blocks it. Return the quantile that lets as many rays pass as the full coat does. Weight each ray by the
/// fraction of directions that escape the coat from its origin, because light matters where it is seen from
/// outside.
///
/// `seen`: the coat at full detail, for the widths before the fit. `spacing`: distance between its strands.
/// `rest`: the skin at rest; null for a groom without a skin. `priorities`: null for those of the groom. The
/// result does not depend on how the groom is divided into leaves. Empty if too few rays are blocked or pass.
/// Each thread needs some MiB for strands and rays, which are charged to MemoryTag::kGrooms. Throws Error
/// (kStopped) if the user has asked to stop.
std::optional<WidthFit> fit_coverage(const Groom& groom, const LimitSurface* rest,
                                     const EvenPriorities* priorities, const Simplification& seen,
                                     float spacing, const Job& job);

}  // namespace pelage
