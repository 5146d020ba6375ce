// SPDX-License-Identifier: Apache-2.0
// The part of EmbreeChunk that passes strands and skins to Embree.
#include "render/accel/embree_chunk.h"
#include "render/accel/embree_query.h"

namespace pelage {

void EmbreeChunk::build() {
  scene_ = rtcNewScene(device_.get());
  if (!scene_) return;
  rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_COMPACT | kEmbreeFilterFlag));
  if (strands_) {
    add_curves();
  } else {
    add_skin();
  }
  rtcCommitScene(scene_);
}

void EmbreeChunk::add_curves() {
  const PackedStrands& strands = *strands_;
  if (strands.segment_count() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), embree_curve_type(strands.basis(), options_.shape));
  if (!geometry) return;
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(strands.motion_keys()));
  for (int key = 0; key < strands.motion_keys(); ++key) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                               RTC_FORMAT_FLOAT4, strands.vertices(key), 0, 4 * sizeof(float),
                               strands.vertex_count());
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, strands.segments(), 0,
                             sizeof(uint32_t), strands.segment_count());
  rtcSetGeometryTessellationRate(geometry, static_cast<float>(kTessellationRate));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

void EmbreeChunk::add_skin() {
  if (skin_.triangle_count() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!geometry) return;
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(skin_.motion_keys));
  for (int key = 0; key < skin_.motion_keys; ++key) {
    const float* positions = &skin_.positions[static_cast<size_t>(key) * skin_.vertex_count() * 3];
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                               RTC_FORMAT_FLOAT3, positions, 0, 3 * sizeof(float), skin_.vertex_count());
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, skin_.triangles.data(), 0,
                             3 * sizeof(uint32_t), skin_.triangle_count());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

/// Finds the boxes that visit_primitives() tests.
void EmbreeChunk::add_triangle_boxes() {
  triangle_boxes_.resize((skin_.triangle_count() + kTrianglesPerBox - 1) / kTrianglesPerBox);
  const size_t vertices = skin_.vertex_count();
  for (size_t i = 0; i < skin_.triangles.size(); ++i) {
    for (int key = 0; key < skin_.motion_keys; ++key) {
      const float* p = &skin_.positions[(static_cast<size_t>(key) * vertices + skin_.triangles[i]) * 3];
      triangle_boxes_[i / (3 * kTrianglesPerBox)].extendBy(V3f(p[0], p[1], p[2]));
    }
  }
}

}  // namespace pelage
