// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_fur.h"

#include <limits>

#include "render/accel/embree_query.h"
#include "render/accel/embree_scene.h"

namespace pelage {

EmbreeFur::EmbreeFur(const Strands& strands, bool compact, int tessellation_rate, MemoryLedger& ledger,
                     const Workers& workers) {
  EmbreeOptions options;
  options.compact = compact;
  options.tessellation_rate = tessellation_rate;
  scene_ = std::make_unique<EmbreeScene>(std::vector{AccelStrands{&strands, 0, {}}},
                                         std::vector<const SkinMesh*>{}, options, ledger, workers);
}
EmbreeFur::~EmbreeFur() = default;

float EmbreeFur::closest(const Ray& ray) const {
  RTCRayHit hit{};
  hit.ray = embree_ray(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  EmbreeQuery query(nullptr);
  embree_intersect(scene_->get(), query, hit);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : hit.ray.tfar;
}

bool EmbreeFur::occluded(const Ray& ray) const {
  RTCRay shadow = embree_ray(ray);
  EmbreeQuery query(nullptr);
  embree_occluded(scene_->get(), query, shadow);
  return shadow.tfar < 0;
}

}  // namespace pelage
