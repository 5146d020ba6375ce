// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "render/gather/gather_point_keys.h"
#include "tests/render/path/path_scene.h"

/// Scenes in which hits are assigned to gather points.
namespace pelage::key_scene {

constexpr int kSize = 100;

/// A camera at z = 10 that shows 4 units in 100 pixels at the origin.
inline Camera camera() {
  CameraParams params;
  params.position = V3f(0, 0, 10);
  params.look_at = V3f(0);
  params.fov = 2 * std::atan(0.2f) * 57.29578f;
  return {params, 1, kSize, kSize};
}

/// Five coats without strands, seen by camera().
inline RenderScene make(const GatherParams& gather) {
  RenderScene scene{{}, {}, {}, LightSet({}), camera(), {}, {}};
  scene.fur.resize(5);
  scene.render.gather = gather;
  return scene;
}

/// A hit on a strand of two segments, at `place` in [0, 1].
inline Hit hit_on(float place) {
  Hit hit;
  hit.kind = HitKind::kStrand;
  hit.part = 3;
  hit.strand_id = 7;
  hit.segment = place < 0.5f ? 0 : 1;
  hit.u = 2 * place - static_cast<float>(hit.segment);
  return hit;
}

/// GatherPointKeys::of() of a thread that has met no strand before.
inline GatherPointKey key_of(const GatherPointKeys& keys, const Hit& hit, const HitGeometry& hit_geometry,
                             const V2f& random) {
  RecentGatherPoints recent;
  return keys.of(hit, hit_geometry, random, recent);
}

}  // namespace pelage::key_scene
