// SPDX-License-Identifier: Apache-2.0
#include "render/frame/skin_shadows.h"

#include <algorithm>

#include "base/memory_budget.h"

namespace pelage {
namespace {

/// Skins are worked on concurrently if this many times the memory of their tessellation is free: so generous
/// that whether it suffices does not depend on which skins meet.
constexpr int64_t kRoom = 16;

/// Position at shutter open of a hit on a skin.
V3f position_at_open(const Hit& hit, const SkinMesh& triangle) {
  return (1 - hit.u - hit.v) * triangle.position(0) + hit.u * triangle.position(1) +
         hit.v * triangle.position(2);
}

}  // namespace

SkinShadows::SkinShadows(const RenderScene& scene, const Job& job) : scene_(scene) {
  balls_.resize(scene.skins.size());
  charges_.resize(scene.skins.size());
  // Many skins concurrently, if their temporary memory fits; few skins one after the other; only
  // the search for balls then uses all threads.
  const auto threads = static_cast<size_t>(job.workers.thread_count());
  size_t largest = 0;
  for (const SkinPart& part : scene.skins) largest = std::max(largest, part.skin->temporary_bytes({}));
  const bool together = scene.skins.size() >= 4 * threads &&
                        has_room(job.ledger, kRoom * static_cast<int64_t>(threads * largest));
  if (together) {
    const Workers alone = Workers::alone();
    job.for_each(balls_.size(), 1, [&](WorkRange range) {
      for (size_t i = range.begin; i < range.end; ++i) balls_[i] = make(i, {alone, job.ledger, job.progress});
    });
  } else {
    for (size_t i = 0; i < balls_.size(); ++i) balls_[i] = make(i, job);
  }
}

std::unique_ptr<const SkinBalls> SkinShadows::make(size_t skin, const Job& job) {
  const SkinPart& part = scene_.skins[skin];
  job.check_stop();
  const auto temporary = static_cast<int64_t>(part.skin->temporary_bytes({}));
  MemoryCharge tessellating =
      reserve(job.ledger, MemoryTag::kSkins, temporary,
              "tessellating the skin of " + part.name + " (render.skin_ball: off needs none)");
  const SkinMesh mesh = part.skin->tessellate({}, scene_.camera.view());
  tessellating = {};
  const std::string purpose = "the skin balls of " + part.name + " (render.skin_ball: off needs none)";
  const auto bytes = static_cast<int64_t>(mesh.bytes() + SkinBalls::temporary_bytes(mesh));
  MemoryCharge building = reserve(job.ledger, MemoryTag::kSkins, bytes, purpose);
  auto balls = std::make_unique<const SkinBalls>(mesh, job);
  building = {};
  if (balls->size() == 0) return nullptr;
  charges_[skin] = reserve(job.ledger, MemoryTag::kSkins, static_cast<int64_t>(balls->bytes()), purpose);
  return balls;
}

SkinShadow SkinShadows::below(const Hit& hit, const HitGeometry& hit_geometry, float time) const {
  const bool on_strand = hit.kind == HitKind::kStrand;
  if (on_strand && !scene_.fur[hit.part].skin) return {};
  const uint32_t skin = on_strand ? *scene_.fur[hit.part].skin : hit.part;
  const auto& balls = balls_[skin];
  if (!balls) return {};
  const auto found =
      balls->find(on_strand ? hit_geometry.strand.point(0) : position_at_open(hit, hit_geometry.triangle));
  if (!found) return {};
  return {balls->ball(*found, time), &balls->bounds()};
}

}  // namespace pelage
