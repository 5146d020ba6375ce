// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/job.h"
#include "base/vector.h"
#include "groom/groom.h"
#include "procedurals/detail/even_priorities.h"
#include "procedurals/detail/parallel_rays.h"
#include "procedurals/skin/rest_pose.h"

namespace pelage {

/// Strands at rest around one root, through which pilot rays are sent.
struct PilotPatch {
  std::vector<StrandPiece> pieces;
  struct Strand {
    uint64_t id;
    float priority;
    V3f up;               ///< the normal of the skin; without a skin, from the root to the tip
    bool starts;          ///< whether rays start on it
    uint32_t begin, end;  ///< indices in `pieces`
  };
  std::vector<Strand> strands;

  /// Bytes of memory of this object.
  size_t bytes() const {
    return sizeof(*this) + pieces.capacity() * sizeof(StrandPiece) + strands.capacity() * sizeof(Strand);
  }
};

/// Grows the strands at rest whose roots are within `radius` of the root of a follicle. Where they are much
/// denser than on average, uses a smaller radius, so that the patch needs a few MiB at most. Rays start on
/// the strands within half the radius. `priorities`: null for those of the groom. Throws Error (kStopped) if
/// the user has asked to stop.
PilotPatch strands_around(const Groom& groom, const RestPose& rest, const EvenPriorities* priorities,
                          size_t follicle, float radius, const Job& job);

}  // namespace pelage
