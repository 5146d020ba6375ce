// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_accel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/parallel.h"
#include "geom/curve.h"
#include "render/accel/crossings.h"
#include "render/accel/embree_curves.h"
#include "render/accel/embree_device.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

RTCGeometryType geometry_type(CurveBasis basis, CurveShape shape) {
  const bool flat = shape == CurveShape::kFlat;
  switch (basis) {
    case CurveBasis::kLinear:
      return flat ? RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE : RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE;
    case CurveBasis::kCatmullRom:
      return flat ? RTC_GEOMETRY_TYPE_FLAT_CATMULL_ROM_CURVE : RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE;
    case CurveBasis::kPinnedBSpline:
    case CurveBasis::kBSpline:
      break;
  }
  return flat ? RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE : RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE;
}

bool is_finite(const Ray& ray) {
  const float sum = ray.origin.x + ray.origin.y + ray.origin.z + ray.direction.x + ray.direction.y +
                    ray.direction.z + ray.near + ray.time;
  return std::isfinite(sum) && !std::isnan(ray.far);
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.near;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = ray.time;
  r.tfar = ray.far;
  r.mask = ~0u;
  r.id = 0;
  r.flags = 0;
  return r;
}

}  // namespace

/// Geometry ids: strand batches first, then skins, in the order given.
struct EmbreeAccel::Impl {
  Impl(int threads, const EmbreeOptions& build_options, MemoryLedger& ledger)
      : options(build_options), device(threads, build_options.memory_limit, ledger) {}
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }

  void attach(RTCGeometry geometry, uint32_t id);
  void add_curves(uint32_t id);
  void add_skin(const SkinMesh& mesh, uint32_t id);
  bool stands_before(uint32_t geom_a, uint32_t prim_a, uint32_t geom_b, uint32_t prim_b) const;
  CrossingPlace crossing(const EmbreeCurves& batch, EmbreeCurves::Place place, float u) const;
  float offset_across(const EmbreeCurves& batch, const Ray& ray, const Hit& hit, const V3f& normal) const;

  EmbreeOptions options;
  EmbreeDevice device;
  RTCScene scene = nullptr;
  std::vector<EmbreeCurves> curves;
  size_t skin_count = 0;
  bool opaque = true;
  MemoryCharge charge;
};

void EmbreeAccel::Impl::attach(RTCGeometry geometry, uint32_t id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void EmbreeAccel::Impl::add_curves(uint32_t id) {
  const EmbreeCurves& batch = curves[id];
  if (batch.segments().empty()) return;
  const Strands& strands = batch.strands();
  RTCGeometry geometry = rtcNewGeometry(device.get(), geometry_type(strands.basis(), options.shape));
  if (!geometry) return;  // the error is kept and thrown after the commit
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(strands.motion_keys()));
  for (int key = 0; key < strands.motion_keys(); ++key) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                               RTC_FORMAT_FLOAT4, batch.vertices(key), 0, 4 * sizeof(float),
                               batch.vertex_count());
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, batch.segments().data(), 0,
                             sizeof(uint32_t), batch.segments().size());
  rtcSetGeometryTessellationRate(geometry, static_cast<float>(options.tessellation_rate));
  attach(geometry, id);
}

void EmbreeAccel::Impl::add_skin(const SkinMesh& mesh, uint32_t id) {
  if (mesh.triangle_count() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!geometry) return;
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(mesh.motion_keys));
  const size_t floats = mesh.vertex_count() * 3;
  for (int key = 0; key < mesh.motion_keys; ++key) {
    // Copied: Embree reads 16 bytes at the last vertex, past the end of an array of exactly 3 floats each.
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, static_cast<unsigned>(key),
                                           RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertex_count());
    if (buffer)
      std::memcpy(buffer, &mesh.positions[static_cast<size_t>(key) * floats], floats * sizeof(float));
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             3 * sizeof(uint32_t), mesh.triangle_count());
  attach(geometry, id);
}

/// The order that decides between equal distances: strands before skins, then by strand id, part and segment.
bool EmbreeAccel::Impl::stands_before(uint32_t geom_a, uint32_t prim_a, uint32_t geom_b,
                                      uint32_t prim_b) const {
  if (geom_a >= curves.size() || geom_b >= curves.size()) {
    return geom_a != geom_b ? geom_a < geom_b : prim_a < prim_b;
  }
  const auto key = [&](uint32_t geom, uint32_t prim) {
    const EmbreeCurves& batch = curves[geom];
    const EmbreeCurves::Place place = batch.locate(prim);
    return CrossingPlace{batch.strands().id(place.strand), batch.part(), place.segment};
  };
  return key(geom_a, prim_a) < key(geom_b, prim_b);
}

CrossingPlace EmbreeAccel::Impl::crossing(const EmbreeCurves& batch, EmbreeCurves::Place place,
                                          float u) const {
  return {batch.strands().id(place.strand), batch.part(), place.segment + (u > 0.5f ? 1u : 0u)};
}

/// h of a hit whose v does not say it: from the surface normal of a round curve, or, where Embree gives none
/// (flat linear segments), from the place of the hit beside the axis.
float EmbreeAccel::Impl::offset_across(const EmbreeCurves& batch, const Ray& ray, const Hit& hit,
                                       const V3f& normal) const {
  const CubicSegment segment = bezier_segment_at(batch.strands(), hit.primitive, hit.segment, ray.time);
  const V3f ez = curve_tangent(segment, hit.u).cross(-ray.direction);
  const float length = ez.length();
  if (length < 1e-12f) return 0;
  float h = 0;
  if (options.shape == CurveShape::kRound) {
    const V3f tangent = curve_tangent(segment, hit.u).normalized();
    const V3f radial = normal - normal.dot(tangent) * tangent;
    h = -radial.normalized().dot(ez) / length;
  } else {
    const V3f beside = ray.origin + hit.distance * ray.direction - curve_position(segment, hit.u);
    const float radius = curve_radius(segment, hit.u);
    h = radius > 0 ? -beside.dot(ez) / (length * radius) : 0;
  }
  return std::clamp(h, -1.0f, 1.0f);
}

EmbreeAccel::EmbreeAccel(std::vector<AccelStrands> strands, std::vector<const SkinMesh*> skins,
                         const EmbreeOptions& options, MemoryLedger& ledger, const Workers& workers) {
#if defined(PELAGE_STD_THREADS)
  const int threads = 1;  // Embree's own tasks run on TBB, which the thread sanitizer cannot follow
#else
  const int threads = workers.thread_count();
#endif
  impl_ = std::make_unique<Impl>(threads, options, ledger);
  Impl& impl = *impl_;
  impl.skin_count = skins.size();
  impl.curves.reserve(strands.size());
  size_t held = 0;
  for (const AccelStrands& batch : strands) {
    impl.curves.emplace_back(batch);
    impl.opaque &= impl.curves.back().opaque();
    held += impl.curves.back().bytes();
  }
  impl.charge = MemoryCharge(ledger, MemoryTag::kChunks, static_cast<int64_t>(held));

  const FlushDenormals flush;
  impl.scene = rtcNewScene(impl.device.get());
  impl.device.rethrow();
  rtcSetSceneFlags(impl.scene, static_cast<RTCSceneFlags>(kEmbreeFilterFlag |
                                                          (options.compact ? RTC_SCENE_FLAG_COMPACT : 0)));
  for (uint32_t i = 0; i < impl.curves.size(); ++i) impl.add_curves(i);
  for (uint32_t i = 0; i < skins.size(); ++i) {
    impl.add_skin(*skins[i], static_cast<uint32_t>(impl.curves.size()) + i);
  }
  rtcCommitScene(impl.scene);
  impl.device.rethrow();
}

EmbreeAccel::~EmbreeAccel() = default;

namespace {

struct NearestQuery : EmbreeQuery {
  using EmbreeQuery::EmbreeQuery;
  const void* impl = nullptr;
  uint32_t random = 0;
  float distance = std::numeric_limits<float>::infinity();
  uint32_t geometry = RTC_INVALID_GEOMETRY_ID;
  uint32_t primitive = 0;
};

struct LightQuery : EmbreeQuery {
  using EmbreeQuery::EmbreeQuery;
  const void* impl = nullptr;
  Crossings crossings;
};

template <class Query>
Query& query_of(const RTCFilterFunctionNArguments* arguments) {
  return static_cast<Query&>(*reinterpret_cast<EmbreeQuery*>(arguments->context));
}

}  // namespace

/// Filters of queries for one ray each (arguments->N is 1).
struct EmbreeFilters {
  using Impl = EmbreeAccel::Impl;

  /// Of two hits at one distance keeps the one that stands first.
  static bool keep(NearestQuery& query, const Impl& impl, float distance, uint32_t geometry,
                   uint32_t primitive) {
    if (distance == query.distance && query.geometry != RTC_INVALID_GEOMETRY_ID &&
        !impl.stands_before(geometry, primitive, query.geometry, query.primitive)) {
      return false;
    }
    query.distance = distance;
    query.geometry = geometry;
    query.primitive = primitive;
    return true;
  }

  static void nearest(const RTCFilterFunctionNArguments* arguments) noexcept {
    auto& query = query_of<NearestQuery>(arguments);
    const auto& impl = *static_cast<const Impl*>(query.impl);
    const uint32_t geometry = RTCHitN_geomID(arguments->hit, 1, 0);
    const uint32_t primitive = RTCHitN_primID(arguments->hit, 1, 0);
    if (!keep(query, impl, RTCRayN_tfar(arguments->ray, 1, 0), geometry, primitive)) arguments->valid[0] = 0;
  }

  static void nearest_stopping(const RTCFilterFunctionNArguments* arguments) noexcept {
    auto& query = query_of<NearestQuery>(arguments);
    const auto& impl = *static_cast<const Impl*>(query.impl);
    const uint32_t geometry = RTCHitN_geomID(arguments->hit, 1, 0);
    const uint32_t primitive = RTCHitN_primID(arguments->hit, 1, 0);
    if (geometry < impl.curves.size() && !impl.curves[geometry].opaque()) {
      const EmbreeCurves& batch = impl.curves[geometry];
      const EmbreeCurves::Place place = batch.locate(primitive);
      const float u = RTCHitN_u(arguments->hit, 1, 0);
      if (!stops_at(query.random, impl.crossing(batch, place, u), batch.opacity(place, u))) {
        arguments->valid[0] = 0;
        return;
      }
    }
    if (!keep(query, impl, RTCRayN_tfar(arguments->ray, 1, 0), geometry, primitive)) arguments->valid[0] = 0;
  }

  static void light(const RTCFilterFunctionNArguments* arguments) noexcept {
    auto& query = query_of<LightQuery>(arguments);
    const auto& impl = *static_cast<const Impl*>(query.impl);
    const uint32_t geometry = RTCHitN_geomID(arguments->hit, 1, 0);
    if (geometry >= impl.curves.size() || impl.curves[geometry].opaque()) return;
    const EmbreeCurves& batch = impl.curves[geometry];
    const EmbreeCurves::Place place = batch.locate(RTCHitN_primID(arguments->hit, 1, 0));
    const float u = RTCHitN_u(arguments->hit, 1, 0);
    const float opacity = batch.opacity(place, u);
    if (opacity >= 1) return;
    if (opacity > 0) query.crossings.add(impl.crossing(batch, place, u), opacity);
    arguments->valid[0] = 0;
  }
};

Hit EmbreeAccel::closest(const Ray& ray) const {
  Hit hit;
  if (!is_finite(ray)) return hit;
  const Impl& impl = *impl_;
  RTCRayHit r;
  r.ray = embree_ray(ray);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  NearestQuery query(impl.opaque ? EmbreeFilters::nearest : EmbreeFilters::nearest_stopping);
  query.impl = &impl;
  query.random = ray.random;
  embree_intersect(impl.scene, query, r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;

  hit.distance = r.ray.tfar;
  hit.u = r.hit.u;
  hit.v = r.hit.v;
  if (r.hit.geomID >= impl.curves.size()) {
    hit.kind = HitKind::kSkin;
    hit.object = r.hit.geomID - static_cast<uint32_t>(impl.curves.size());
    hit.primitive = r.hit.primID;
    return hit;
  }
  const EmbreeCurves& batch = impl.curves[r.hit.geomID];
  const EmbreeCurves::Place place = batch.locate(r.hit.primID);
  hit.kind = HitKind::kStrand;
  hit.object = r.hit.geomID;
  hit.primitive = place.strand;
  hit.segment = place.segment;
  if (impl.options.shape == CurveShape::kRound || batch.strands().basis() == CurveBasis::kLinear) {
    hit.v = impl.offset_across(batch, ray, hit, {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z});
  }
  return hit;
}

float EmbreeAccel::transmittance(const Ray& ray) const {
  if (!is_finite(ray)) return 1;
  const Impl& impl = *impl_;
  RTCRay r = embree_ray(ray);
  if (impl.opaque) {
    EmbreeQuery query(nullptr);
    embree_occluded(impl.scene, query, r);
    return r.tfar < 0 ? 0.0f : 1.0f;
  }
  LightQuery query(EmbreeFilters::light);
  query.impl = &impl;
  embree_occluded(impl.scene, query, r);
  return r.tfar < 0 ? 0.0f : query.crossings.transmittance();
}

bool EmbreeAccel::opaque() const { return impl_->opaque; }

Box3f EmbreeAccel::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(impl_->scene, &b);
  if (b.lower_x > b.upper_x) return {};
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

}  // namespace pelage
