// SPDX-License-Identifier: Apache-2.0
#include "tests/render/accel/embree_accel.h"

#include <algorithm>
#include <set>

#include "render/accel/crossings.h"
#include "render/accel/embree_query.h"

namespace pelage {
namespace {

struct NearestQuery : EmbreeQuery {
  NearestQuery(RTCFilterFunctionN filter_function, const EmbreeScene& in_scene, const Ray& ray)
      : EmbreeQuery(filter_function), scene(in_scene), random(ray.random), far(ray.far) {}
  const EmbreeScene& scene;
  uint32_t random;
  float far;
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

bool is_opaque(const EmbreeScene& scene, uint32_t geometry) {
  return scene.is_skin(geometry) || scene.curves(geometry).opaque();
}
/// Where a ray leaves a round strand. The crossing was counted on entry.
bool is_exit(const EmbreeScene& scene, const EmbreeReport& report) {
  return scene.is_round() && report.faces_away();
}

/// Of two hits at the same distance, keeps the one that precedes the other.
void keep_nearest(const RTCFilterFunctionNArguments* arguments) noexcept {
  const EmbreeReport report(arguments);
  auto& query = report.query<NearestQuery>();
  const float distance = report.distance();
  const uint32_t geometry = report.geometry(), primitive = report.primitive();
  if (distance > query.distance) {
    report.reject();
    return;
  }
  if (distance == query.distance && query.geometry != RTC_INVALID_GEOMETRY_ID &&
      !query.scene.precedes(geometry, primitive, query.geometry, query.primitive)) {
    report.reject();
    return;
  }
  query.distance = distance;
  query.geometry = geometry;
  query.primitive = primitive;
  if (const float longest = query.scene.longest_segment(); longest > 0) {
    report.set_ray_end(std::min(query.far, far_behind(distance, longest)));
  }
  if (!query.scene.is_skin(geometry)) query.scene.curves(geometry).fetch_ahead(primitive);
}

/// The same for semi-transparent strands.
void keep_nearest_stopping(const RTCFilterFunctionNArguments* arguments) noexcept {
  const EmbreeReport report(arguments);
  const auto& query = report.query<NearestQuery>();
  if (!is_opaque(query.scene, report.geometry())) {
    const EmbreeCurves& batch = query.scene.curves(report.geometry());
    const EmbreeCurves::Place place = batch.locate(report.primitive());
    const CrossingPlace crossing = query.scene.crossing(batch, place, report.u());
    if (is_exit(query.scene, report) || !stops_at(query.random, crossing, batch.opacity(place, report.u()))) {
      report.reject();
      return;
    }
  }
  keep_nearest(arguments);
}

/// Collects semi-transparent crossings; an opaque one ends the query.
void collect_crossings(const RTCFilterFunctionNArguments* arguments) noexcept {
  const EmbreeReport report(arguments);
  auto& query = report.query<LightQuery>();
  if (is_opaque(query.scene, report.geometry())) return;
  const EmbreeCurves& batch = query.scene.curves(report.geometry());
  const EmbreeCurves::Place place = batch.locate(report.primitive());
  const float opacity = batch.opacity(place, report.u());
  if (opacity >= 1) return;
  if (opacity > 0 && !is_exit(query.scene, report)) {
    query.crossings.add(query.scene.crossing(batch, place, report.u()), opacity);
  }
  report.reject();
}

}  // namespace

Hit EmbreeAccel::closest(const Ray& ray, TraceThread& thread) const {
  Hit hit;
  if (!is_finite(ray)) return hit;
  RTCRayHit r;
  r.ray = embree_ray(ray);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  NearestQuery query(scene_->opaque() ? keep_nearest : keep_nearest_stopping, *scene_, ray);
  embree_intersect(scene_->get(), query, r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;

  hit.distance = query.distance;
  hit.u = r.hit.u;
  if (scene_->is_skin(r.hit.geomID)) {
    hit.kind = HitKind::kSkin;
    hit.part = scene_->skin(r.hit.geomID);
    hit.v = r.hit.v;
    thread.hit_geometry.triangle.assign_triangle(scene_->skin_mesh(r.hit.geomID), r.hit.primID);
    return hit;
  }
  const EmbreeCurves& batch = scene_->curves(r.hit.geomID);
  const EmbreeCurves::Place place = batch.locate(r.hit.primID);
  hit.kind = HitKind::kStrand;
  hit.part = batch.part();
  hit.strand_id = batch.strands().id(place.strand);
  hit.segment = place.segment;
  hit.v = -r.hit.v;  // Embree's sign convention is opposite
  thread.hit_geometry.strand.assign_strand(batch.strands(), place.strand);
  if (scene_->is_round() || batch.strands().basis() == CurveBasis::kLinear) {
    const V3f normal(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    hit.v = offset_across(thread.hit_geometry.strand, scene_->is_round(), ray, hit, normal);
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

/// Counts with one ray after another, each from the last hit on: the slow truth of ChunkAccel's count. Only
/// for opaque strands.
StrandCount EmbreeAccel::strands_crossed(const Ray& ray, uint32_t max, TraceThread& thread) const {
  const float kEnd = std::numeric_limits<float>::infinity();
  std::set<CrossingPlace> places;
  Ray rest = ray;
  while (const Hit hit = closest(rest, thread)) {
    if (hit.kind == HitKind::kSkin) return {kEnd, 0};
    places.insert({hit.strand_id, hit.part, hit.segment + joint_beside(hit.u, kTessellationRate)});
    if (places.size() > max) return {kEnd, 0};
    rest.near = std::nextafter(hit.distance, kEnd);
  }
  return {static_cast<float>(places.size()), places.empty() ? 1.0f : 0.0f};
}

bool EmbreeAccel::opaque() const { return scene_->opaque(); }

Box3f EmbreeAccel::bounds() const {
  RTCBounds b;
  rtcGetSceneBounds(scene_->get(), &b);
  if (b.lower_x > b.upper_x) return {};
  return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

}  // namespace pelage
