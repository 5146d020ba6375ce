// SPDX-License-Identifier: Apache-2.0
#include "tests/render/accel/embree_scene.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "base/parallel.h"
#include "render/accel/embree_query.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

bool needs_phantoms(CurveBasis basis) {
  return basis == CurveBasis::kPinnedBSpline || basis == CurveBasis::kCatmullRom;
}

}  // namespace

EmbreeCurves::EmbreeCurves(const AccelStrands& source) : source_(source) {
  const Strands& strands = *source_.strands;
  PELAGE_CHECK(source_.opacity.empty() || source_.opacity.size() == strands.point_count());
  const size_t count = strands.strand_count();
  const bool phantoms = needs_phantoms(strands.basis());
  vertex_count_ = strands.point_count() + (phantoms ? 2 * count : 0);

  size_t total = 0;
  bool uniform = true;
  for (size_t s = 0; s < count; ++s) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    uniform &= segments == segment_count(strands.basis(), strands.strand_points(0));
    total += segments;
  }
  first_vertex_.reserve(total);
  if (uniform && count > 0) {
    segments_per_strand_ = static_cast<uint32_t>(total / count);
    points_per_strand_ = strands.strand_points(0);
  } else {
    strand_of_segment_.reserve(total);
    first_segment_.reserve(count);
  }
  for (size_t s = 0; s < count; ++s) {
    const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
    const uint32_t base = strands.first_point(s) + (phantoms ? 2 * static_cast<uint32_t>(s) : 0);
    if (!uniform) {
      first_segment_.push_back(static_cast<uint32_t>(first_vertex_.size()));
      strand_of_segment_.insert(strand_of_segment_.end(), segments, static_cast<uint32_t>(s));
    }
    for (uint32_t i = 0; i < segments; ++i) first_vertex_.push_back(base + i);
  }
  if (phantoms) copy_with_phantoms();
}

void EmbreeCurves::copy_with_phantoms() {
  const Strands& strands = *source_.strands;
  copy_.resize(vertex_count_ * 4 * static_cast<size_t>(strands.motion_keys()));
  float* out = copy_.data();
  for (int key = 0; key < strands.motion_keys(); ++key) {
    const float* points = strands.points(key).data();
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      const uint32_t n = strands.strand_points(s);
      const float* p = points + size_t(4) * strands.first_point(s);
      const float* last = p + size_t(4) * (n - 1);
      for (int c = 0; c < 4; ++c) out[c] = n > 1 ? 2 * p[c] - p[4 + c] : 0;
      std::copy_n(p, size_t(4) * n, out + 4);
      out += size_t(4) * (n + 1);
      for (int c = 0; c < 4; ++c) out[c] = n > 1 ? 2 * last[c] - last[c - 4] : 0;
      out += 4;
    }
  }
}

const float* EmbreeCurves::vertices(int key) const {
  if (copy_.empty()) return strands().points(key).data();
  return copy_.data() + static_cast<size_t>(key) * vertex_count_ * 4;
}

EmbreeCurves::Place EmbreeCurves::locate(uint32_t primitive) const {
  if (strand_of_segment_.empty()) {
    const uint32_t strand = primitive / segments_per_strand_;
    return {strand, primitive - strand * segments_per_strand_};
  }
  const uint32_t strand = strand_of_segment_[primitive];
  return {strand, primitive - first_segment_[strand]};
}

float EmbreeCurves::opacity(Place place, float u) const {
  if (opaque()) return 1;
  // As in interpolate_attribute(): a span of an unpinned B-spline lies between its second and third points.
  const size_t before = strands().basis() == CurveBasis::kBSpline ? 1 : 0;
  const float* o = &source_.opacity[strands().first_point(place.strand) + place.segment + before];
  return interpolate(o[0], o[1], u);
}

void EmbreeCurves::fetch_ahead(uint32_t primitive) const {
#if defined(__GNUC__)
  if (segments_per_strand_ == 0) return;
  const size_t strand = primitive / segments_per_strand_;
  const StrandArrays& arrays = strands().arrays();
  const float* points = &arrays.points[4 * strand * points_per_strand_];
  for (uint32_t i = 0; i < points_per_strand_; i += 4) __builtin_prefetch(points + 4 * i);
  __builtin_prefetch(points + 4 * (points_per_strand_ - 1));
  __builtin_prefetch(&arrays.first_point[strand]);
  __builtin_prefetch(&arrays.ids[strand]);
#endif
}

EmbreeScene::EmbreeScene(const std::vector<AccelStrands>& strands, const std::vector<const SkinMesh*>& skins,
                         const EmbreeOptions& options, const Workers& workers)
    : options_(options), device_(rtcNewDevice(nullptr)), skins_(skins) {
  PELAGE_CHECK(options_.tessellation_rate >= 2 && options_.tessellation_rate <= 16 &&
               options_.tessellation_rate % 2 == 0);
  curves_.reserve(strands.size());
  for (const AccelStrands& batch : strands) {
    curves_.emplace_back(batch);
    opaque_ &= curves_.back().opaque();
    longest_segment_ = std::max(longest_segment_, pelage::longest_segment(*batch.strands, options_.shape));
  }

  const FlushDenormals flush;
  scene_ = rtcNewScene(device_);
  check();
  const int flags = kEmbreeFilterFlag | (options_.compact ? RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE);
  rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(flags));
  for (uint32_t i = 0; i < curves_.size(); ++i) add_curves(i);
  for (uint32_t i = 0; i < skins.size(); ++i) {
    add_skin(*skins[i], static_cast<uint32_t>(curves_.size()) + i);
  }
  workers.run_library([&] { rtcCommitScene(scene_); });
  check();
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::check() const { PELAGE_CHECK(rtcGetDeviceError(device_) == RTC_ERROR_NONE); }

void EmbreeScene::attach(RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, id);
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::add_curves(uint32_t id) {
  const EmbreeCurves& batch = curves_[id];
  if (batch.segments().empty()) return;
  const Strands& strands = batch.strands();
  RTCGeometry geometry = rtcNewGeometry(device_, embree_curve_type(strands.basis(), options_.shape));
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
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(mesh.motion_keys));
  const size_t floats = mesh.vertex_count() * 3;
  for (int key = 0; key < mesh.motion_keys; ++key) {
    // Copied, because Embree reads 16 bytes at the last vertex, beyond the end of an array of exactly 3
    // floats each.
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                                           RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertex_count());
    PELAGE_CHECK(buffer);
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
