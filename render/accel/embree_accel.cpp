// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_accel.h"

#include <algorithm>
#include <cmath>

#include "geom/curve.h"
#include "render/accel/embree_scene.h"

namespace pelage {
namespace {

struct NearestQuery : EmbreeQuery {
  NearestQuery(RTCFilterFunctionN filter_function, const EmbreeScene& in_scene, uint32_t random_word)
      : EmbreeQuery(filter_function), scene(in_scene), random(random_word) {}
  const EmbreeScene& scene;
  uint32_t random;
  float distance = std::numeric_limits<float>::infinity();
  uint32_t geometry = RTC_INVALID_GEOMETRY_ID;
  uint32_t primitive = 0;
};

struct LightQuery : EmbreeQuery {
  LightQuery(RTCFilterFunctionN filter_function, const EmbreeScene& in_scene)
      : EmbreeQuery(filter_function), scene(in_scene) {}
  const EmbreeScene& scene;
  Crossings crossings;
};

/// What Embree hands to a filter about one candidate of one ray (N is 1).
template <class Query>
struct Report {
  explicit Report(const RTCFilterFunctionNArguments* filter_arguments)
      : arguments(filter_arguments),
        query(static_cast<Query&>(*reinterpret_cast<EmbreeQuery*>(arguments->context))),
        geometry(RTCHitN_geomID(arguments->hit, 1, 0)),
        primitive(RTCHitN_primID(arguments->hit, 1, 0)) {}

  float distance() const { return RTCRayN_tfar(arguments->ray, 1, 0); }
  float u() const { return RTCHitN_u(arguments->hit, 1, 0); }
  bool is_opaque() const { return query.scene.is_skin(geometry) || query.scene.curves(geometry).opaque(); }
  /// Where a ray leaves a round strand. It was counted where it entered.
  bool is_exit() const {
    if (!query.scene.is_round()) return false;
    return RTCHitN_Ng_x(arguments->hit, 1, 0) * RTCRayN_dir_x(arguments->ray, 1, 0) +
               RTCHitN_Ng_y(arguments->hit, 1, 0) * RTCRayN_dir_y(arguments->ray, 1, 0) +
               RTCHitN_Ng_z(arguments->hit, 1, 0) * RTCRayN_dir_z(arguments->ray, 1, 0) >
           0;
  }
  void reject() const { arguments->valid[0] = 0; }

  const RTCFilterFunctionNArguments* arguments;
  Query& query;
  uint32_t geometry, primitive;
};

/// Of two hits at one distance keeps the one that stands first.
void keep_nearest(const RTCFilterFunctionNArguments* arguments) noexcept {
  const Report<NearestQuery> report(arguments);
  NearestQuery& query = report.query;
  const float distance = report.distance();
  if (distance == query.distance && query.geometry != RTC_INVALID_GEOMETRY_ID &&
      !query.scene.stands_before(report.geometry, report.primitive, query.geometry, query.primitive)) {
    report.reject();
    return;
  }
  query.distance = distance;
  query.geometry = report.geometry;
  query.primitive = report.primitive;
  if (!query.scene.is_skin(report.geometry))
    query.scene.curves(report.geometry).fetch_ahead(report.primitive);
}

/// The same where strands are semi-transparent.
void keep_nearest_stopping(const RTCFilterFunctionNArguments* arguments) noexcept {
  const Report<NearestQuery> report(arguments);
  if (!report.is_opaque()) {
    const EmbreeCurves& batch = report.query.scene.curves(report.geometry);
    const EmbreeCurves::Place place = batch.locate(report.primitive);
    const CrossingPlace crossing = report.query.scene.crossing(batch, place, report.u());
    if (report.is_exit() || !stops_at(report.query.random, crossing, batch.opacity(place, report.u()))) {
      report.reject();
      return;
    }
  }
  keep_nearest(arguments);
}

/// Collects semi-transparent crossings; an opaque one ends the query.
void collect_crossings(const RTCFilterFunctionNArguments* arguments) noexcept {
  const Report<LightQuery> report(arguments);
  if (report.is_opaque()) return;
  const EmbreeCurves& batch = report.query.scene.curves(report.geometry);
  const EmbreeCurves::Place place = batch.locate(report.primitive);
  const float opacity = batch.opacity(place, report.u());
  if (opacity >= 1) return;
  if (opacity > 0 && !report.is_exit()) {
    report.query.crossings.add(report.query.scene.crossing(batch, place, report.u()), opacity);
  }
  report.reject();
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

/// h of a hit whose v does not say it: from the surface normal of a round curve, or, where Embree gives none
/// (flat linear segments), from the place of the hit beside the axis.
float offset_across(const Strands& strand, bool round, const Ray& ray, const Hit& hit, const V3f& normal) {
  const CubicSegment segment = bezier_segment_at(strand, 0, hit.segment, ray.time);
  const V3f tangent = curve_tangent(segment, hit.u).normalized();
  const V3f ez = tangent.cross(-ray.direction).normalized();
  float h = 0;
  if (round) {
    h = -(normal - normal.dot(tangent) * tangent).normalized().dot(ez);
  } else {
    const float radius = curve_radius(segment, hit.u);
    const V3f beside = ray.origin + hit.distance * ray.direction - curve_position(segment, hit.u);
    h = radius > 0 ? -beside.dot(ez) / radius : 0;
  }
  return std::clamp(h, -1.0f, 1.0f);
}

}  // namespace

EmbreeAccel::EmbreeAccel(std::vector<AccelStrands> strands, std::vector<const SkinMesh*> skins,
                         const EmbreeOptions& options, MemoryLedger& ledger, const Workers& workers)
    : scene_(std::make_unique<EmbreeScene>(strands, skins, options, ledger, workers)) {}

EmbreeAccel::~EmbreeAccel() = default;

Hit EmbreeAccel::closest(const Ray& ray, TraceThread& thread) const {
  Hit hit;
  if (!is_finite(ray)) return hit;
  RTCRayHit r;
  r.ray = embree_ray(ray);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  NearestQuery query(scene_->opaque() ? keep_nearest : keep_nearest_stopping, *scene_, ray.random);
  embree_intersect(scene_->get(), query, r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;

  hit.distance = r.ray.tfar;
  hit.u = r.hit.u;
  if (scene_->is_skin(r.hit.geomID)) {
    hit.kind = HitKind::kSkin;
    hit.part = scene_->skin(r.hit.geomID);
    hit.v = r.hit.v;
    thread.met.triangle.assign_triangle(scene_->skin_mesh(r.hit.geomID), r.hit.primID);
    return hit;
  }
  const EmbreeCurves& batch = scene_->curves(r.hit.geomID);
  const EmbreeCurves::Place place = batch.locate(r.hit.primID);
  hit.kind = HitKind::kStrand;
  hit.part = batch.part();
  hit.strand_id = batch.strands().id(place.strand);
  hit.segment = place.segment;
  hit.v = -r.hit.v;  // Embree counts from the other edge
  thread.met.strand.assign_strand(batch.strands(), place.strand);
  if (scene_->is_round() || batch.strands().basis() == CurveBasis::kLinear) {
    const V3f normal(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    hit.v = offset_across(thread.met.strand, scene_->is_round(), ray, hit, normal);
  }
  return hit;
}

float EmbreeAccel::transmittance(const Ray& ray, TraceThread&) const {
  if (!is_finite(ray)) return 1;
  RTCRay r = embree_ray(ray);
  if (scene_->opaque()) {
    EmbreeQuery query(nullptr);
    embree_occluded(scene_->get(), query, r);
    return r.tfar < 0 ? 0.0f : 1.0f;
  }
  LightQuery query(collect_crossings, *scene_);
  embree_occluded(scene_->get(), query, r);
  return r.tfar < 0 ? 0.0f : query.crossings.transmittance();
}

bool EmbreeAccel::opaque() const { return scene_->opaque(); }

Box3f EmbreeAccel::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(scene_->get(), &b);
  if (b.lower_x > b.upper_x) return {};
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

}  // namespace pelage
