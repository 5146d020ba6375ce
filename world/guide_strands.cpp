// SPDX-License-Identifier: Apache-2.0
#include "world/guide_strands.h"

#include "base/check.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/operators/follow.h"
#include "world/guide_poses.h"

namespace pelage {
namespace {

/// Bytes that a point of a guide takes, as groomed and in the result.
constexpr size_t kBytesOfWrittenPoint = 80;

}  // namespace

Strands guide_strands(const Assets& assets, const MovingCoat& coat, double frame, const GuideTurns& turns,
                      const Job& job) {
  const size_t guides = coat.groom->guides()->follicles.size();
  const MemoryCharge charge = reserve(job.ledger, MemoryTag::kGrooms,
                                      static_cast<int64_t>((coat.segments() + guides) * kBytesOfWrittenPoint),
                                      "the guides of " + coat.name);
  PELAGE_CHECK(turns.empty() || turns.size() == 4 * coat.segments());
  const LimitSurface& rest = *assets.skins.at(coat.character.params->parts[coat.part].skin.name).rest;
  const double scale = coat.character.params->transform.scale.at(frame);
  const std::vector<GuideShape> shapes = groomed_guides(*coat.groom, rest, scale, job);
  const std::vector<RodRoot> roots =
      guide_roots(*coat.groom, posed_skin(coat.character, coat.part, assets, frame), 1);
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  size_t segment = 0;
  for (size_t g = 0; g < shapes.size(); ++g) {
    V3d point = roots[g].position;
    for (size_t i = 0; i < shapes[g].points.size(); ++i) {
      if (i > 0) {
        V3d along = turned(roots[g].frame, shapes[g].points[i] - shapes[g].points[i - 1]);
        if (!turns.empty()) {
          const float* q = &turns[4 * segment++];
          along = turned(Imath::Quatd(q[3], q[0], q[1], q[2]).normalized(), along);
        }
        point += along;
      }
      for (const double c : {point.x, point.y, point.z}) arrays.points.push_back(static_cast<float>(c));
      arrays.points.push_back(0);
    }
    arrays.ids.push_back(g);
    arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
  }
  return Strands(std::move(arrays));
}

}  // namespace pelage
