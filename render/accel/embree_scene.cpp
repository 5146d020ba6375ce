// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_scene.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "base/parallel.h"
#include "render/accel/embree_query.h"
#include "render/accel/flush_denormals.h"

namespace pelage {

EmbreeScene::EmbreeScene(const std::vector<AccelStrands>& strands, const std::vector<const SkinMesh*>& skins,
                         const EmbreeOptions& options, MemoryLedger& ledger, const Workers& workers)
    : options_(options), device_(options.memory_limit, ledger), skins_(skins) {
  PELAGE_CHECK(options_.tessellation_rate >= 2 && options_.tessellation_rate <= 16 &&
               options_.tessellation_rate % 2 == 0);
  curves_.reserve(strands.size());
  size_t held = 0;
  for (const AccelStrands& batch : strands) {
    curves_.emplace_back(batch);
    opaque_ &= curves_.back().opaque();
    longest_segment_ = std::max(longest_segment_, pelage::longest_segment(*batch.strands, options_.shape));
    held += curves_.back().bytes();
  }
  charge_ = MemoryCharge(ledger, MemoryTag::kChunks, static_cast<int64_t>(held));

  const FlushDenormals flush;
  scene_ = rtcNewScene(device_.get());
  device_.rethrow();
  try {
    const int flags = kEmbreeFilterFlag | (options_.compact ? RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE);
    rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(flags));
    for (uint32_t i = 0; i < curves_.size(); ++i) add_curves(i);
    for (uint32_t i = 0; i < skins.size(); ++i) {
      add_skin(*skins[i], static_cast<uint32_t>(curves_.size()) + i);
    }
    workers.run_library([&] { rtcCommitScene(scene_); });
    device_.rethrow();
  } catch (...) {
    rtcReleaseScene(scene_);
    throw;
  }
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

void EmbreeScene::attach(RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::add_curves(uint32_t id) {
  const EmbreeCurves& batch = curves_[id];
  if (batch.segments().empty()) return;
  const Strands& strands = batch.strands();
  RTCGeometry geometry = rtcNewGeometry(device_.get(), embree_curve_type(strands.basis(), options_.shape));
  device_.rethrow();
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(strands.motion_keys()));
  for (int key = 0; key < strands.motion_keys(); ++key) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                               RTC_FORMAT_FLOAT4, batch.vertices(key), 0, 4 * sizeof(float),
                               batch.vertex_count());
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, batch.segments().data(), 0,
                             sizeof(uint32_t), batch.segments().size());
  rtcSetGeometryTessellationRate(geometry, static_cast<float>(options_.tessellation_rate));
  attach(geometry, id);
}

void EmbreeScene::add_skin(const SkinMesh& mesh, uint32_t id) {
  if (mesh.triangle_count() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  device_.rethrow();
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(mesh.motion_keys));
  const size_t floats = mesh.vertex_count() * 3;
  for (int key = 0; key < mesh.motion_keys; ++key) {
    // Copied, because Embree reads 16 bytes at the last vertex, beyond the end of an array of exactly 3
    // floats each.
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                                           RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertex_count());
    if (!buffer) break;  // the commit detects it, and the error is thrown afterwards
    std::memcpy(buffer, &mesh.positions[static_cast<size_t>(key) * floats], floats * sizeof(float));
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             3 * sizeof(uint32_t), mesh.triangle_count());
  attach(geometry, id);
}

bool EmbreeScene::precedes(uint32_t geometry_a, uint32_t primitive_a, uint32_t geometry_b,
                           uint32_t primitive_b) const {
  if (is_skin(geometry_a) || is_skin(geometry_b)) {
    return geometry_a != geometry_b ? geometry_a < geometry_b : primitive_a < primitive_b;
  }
  const auto key = [&](uint32_t geometry, uint32_t primitive) {
    const EmbreeCurves& batch = curves_[geometry];
    const EmbreeCurves::Place place = batch.locate(primitive);
    return CrossingPlace{batch.strands().id(place.strand), batch.part(), place.segment};
  };
  return key(geometry_a, primitive_a) < key(geometry_b, primitive_b);
}

CrossingPlace EmbreeScene::crossing(const EmbreeCurves& batch, EmbreeCurves::Place place, float u) const {
  return {batch.strands().id(place.strand), batch.part(),
          place.segment + joint_beside(u, options_.tessellation_rate)};
}

}  // namespace pelage
