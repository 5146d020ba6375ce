// SPDX-License-Identifier: Apache-2.0
#include "render/accel/embree_chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "base/heap.h"
#include "base/parallel.h"
#include "render/accel/embree_query.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

// Upper bounds of Embree's allocations, measured with trees over strands and skins of all kinds and sizes,
// with 1 to 4 motion keys; embree_chunk_test checks them.
constexpr size_t kPerScene = 4096;    // the first node and small objects
constexpr size_t kPerPrimitive = 52;  // of a tree without motion; 40 to 44 are typical
constexpr size_t kPerFew = 140;       // extra for the first primitives, whose nodes are half empty
constexpr size_t kFew = 48;           // number of these
constexpr size_t kReference = 32;     // per primitive during the build, in powers of two
constexpr size_t kPerMoving = 95;  // per primitive and pair of motion keys: time may be split between any two
constexpr size_t kPerMovingTriangle = 60;  // the same for skins
constexpr size_t kMovingReference = 80;    // per primitive and pair of keys during the build

size_t tree_bytes_bound(const ChunkCounts& n) {
  const size_t primitives = n.segments + n.triangles, pairs_of_keys = static_cast<size_t>(n.motion_keys - 1);
  if (primitives == 0) return kPerScene;
  const size_t few = kPerScene + kPerFew * std::min(primitives, kFew) * std::max<size_t>(pairs_of_keys, 1);
  const size_t moving = kPerMoving * n.segments + kPerMovingTriangle * n.triangles;
  const size_t tree = few + (pairs_of_keys == 0 ? kPerPrimitive * primitives : moving * pairs_of_keys);
  // The last block is partially used.
  return (tree / EmbreeDevice::kTreeBlock + 2) * EmbreeDevice::kTreeBlock;
}
size_t reference_bytes_bound(size_t primitives, size_t pairs_of_keys) {
  if (pairs_of_keys == 0) return heap_bytes(kReference * std::bit_ceil(std::max<size_t>(primitives, 1)));
  return heap_bytes(kMovingReference * primitives * pairs_of_keys);
}

/// Positions and normals; indices, faces and corners; boxes.
size_t skin_bytes_bound(const ChunkCounts& n) {
  return 24 * static_cast<size_t>(n.motion_keys) * n.vertices + 41 * n.triangles + 96;
}

/// Embree reads 16 bytes at each vertex, so 4 bytes after the last one must be valid.
void pad_for_embree(std::vector<float>& positions) {
  if (positions.capacity() == positions.size()) positions.reserve(positions.size() + 1);
}

}  // namespace

struct EmbreeChunk::Query : EmbreeQuery {
  Query(RTCFilterFunctionN filter_function, const EmbreeChunk& in_chunk, const Ray& of)
      : EmbreeQuery(filter_function), chunk(in_chunk), ray(of), starts_here(in_chunk.starts_here(of)) {}

  /// Distance of a candidate from the ray's origin, rather than from where Embree's ray starts.
  float distance_of(const EmbreeReport& report) const { return report.distance() - chunk.before_; }
  bool is_start(const EmbreeReport& report) const {
    return starts_here && chunk.is_start(ray, report.primitive(), report.u(), distance_of(report));
  }

  const EmbreeChunk& chunk;
  const Ray& ray;
  const bool starts_here;
};

struct EmbreeChunk::NearestQuery : Query {
  NearestQuery(RTCFilterFunctionN filter_function, const EmbreeChunk& in_chunk, const Ray& of,
               const NearestSoFar& nearest_so_far)
      : Query(filter_function, in_chunk, of),
        nearest(nearest_so_far),
        distance(nearest_so_far.hit.distance) {}
  const NearestSoFar& nearest;
  float distance;  // of the primitive or, if there is none, of `nearest`
  uint32_t primitive = RTC_INVALID_GEOMETRY_ID;
};

struct EmbreeChunk::LightQuery : Query {
  LightQuery(RTCFilterFunctionN filter_function, const EmbreeChunk& in_chunk, const Ray& of, Crossings& into)
      : Query(filter_function, in_chunk, of), crossings(into) {}
  Crossings& crossings;
};

struct EmbreeChunk::Filters {
  static NearestSoFar place_of(const EmbreeChunk& chunk, uint32_t primitive) {
    NearestSoFar found;
    found.hit.part = chunk.part_;
    if (!chunk.strands_) {
      found.hit.kind = HitKind::kSkin;
      found.face = chunk.skin_.faces[primitive];
      found.triangle = primitive;
      return found;
    }
    const PackedStrands::Place place = chunk.strands_->locate(primitive);
    found.hit.kind = HitKind::kStrand;
    found.hit.strand_id = chunk.strands_->id(place.strand);
    found.hit.segment = place.segment;
    return found;
  }

  /// Of two hits at the same distance, keeps the one that precedes the other.
  static void keep_nearest(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    auto& query = report.query<NearestQuery>();
    const EmbreeChunk& chunk = query.chunk;
    const uint32_t primitive = report.primitive();
    const float distance = query.distance_of(report);
    if (distance > query.distance || query.is_start(report)) {
      report.reject();
      return;
    }
    if (distance == query.distance) {
      const bool here = query.primitive != RTC_INVALID_GEOMETRY_ID;
      if ((here || query.nearest.hit) &&
          place_of(chunk, primitive).rank() >=
              (here ? place_of(chunk, query.primitive) : query.nearest).rank()) {
        report.reject();
        return;
      }
    }
    query.distance = distance;
    query.primitive = primitive;
    if (chunk.longest_ > 0) {
      report.set_ray_end(std::min(query.ray.far, far_behind(query.distance, chunk.longest_)));
    }
    if (chunk.strands_) chunk.strands_->fetch_ahead(primitive);
  }

  /// The same for semi-transparent strands.
  static void keep_nearest_stopping(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    const auto& query = report.query<NearestQuery>();
    const EmbreeChunk& chunk = query.chunk;
    const PackedStrands::Place place = chunk.strands_->locate(report.primitive());
    if (is_exit(chunk, report) || !stops_at(query.ray.random, chunk.crossing(place, report.u()),
                                            chunk.strands_->opacity(place, report.u()))) {
      report.reject();
      return;
    }
    keep_nearest(arguments);
  }

  /// Collects semi-transparent crossings; an opaque one that is not the ray's own start ends the query.
  static void collect_crossings(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    auto& query = report.query<LightQuery>();
    const EmbreeChunk& chunk = query.chunk;
    const PackedStrands::Place place = chunk.strands_->locate(report.primitive());
    const float opacity = query.is_start(report) ? 0.0f : chunk.strands_->opacity(place, report.u());
    if (opacity >= 1) return;
    if (opacity > 0 && !is_exit(chunk, report)) {
      query.crossings.add(chunk.crossing(place, report.u()), opacity);
    }
    report.reject();
  }

  /// Collects all crossings that are not the ray's own start; the one that is too many ends the query.
  static void count_crossings(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    auto& query = report.query<LightQuery>();
    const EmbreeChunk& chunk = query.chunk;
    const PackedStrands::Place place = chunk.strands_->locate(report.primitive());
    const float opacity =
        query.is_start(report) || is_exit(chunk, report) ? 0.0f : chunk.strands_->opacity(place, report.u());
    if (opacity > 0 && !query.crossings.count(chunk.crossing(place, report.u()), opacity)) return;
    report.reject();
  }

  /// For secondary rays that see strands through a screen door.
  static void keep_nearest_at_door(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    const auto& query = report.query<NearestQuery>();
    if (is_exit(query.chunk, report) || !meets_door(query, report)) {
      report.reject();
    } else {
      keep_nearest(arguments);
    }
  }
  static void block_at_door(const RTCFilterFunctionNArguments* arguments) noexcept {
    const EmbreeReport report(arguments);
    const auto& query = report.query<LightQuery>();
    if (query.is_start(report) || !meets_door(query, report)) report.reject();
  }
  static bool meets_door(const Query& query, const EmbreeReport& report) {
    const EmbreeChunk& chunk = query.chunk;
    const PackedStrands::Place place = chunk.strands_->locate(report.primitive());
    const float opacity = chunk.strands_->opacity(place, report.u());
    if (opacity >= 1) return true;
    if (is_exit(chunk, report)) return false;
    float h = -report.v();
    if (chunk.v_is_no_offset()) {
      Hit hit;
      hit.distance = query.distance_of(report);
      hit.segment = place.segment;
      hit.u = report.u();
      Strands strand;
      chunk.strands_->copy_strand(place.strand, strand);
      h = offset_across(strand, chunk.options_.shape == CurveShape::kRound, query.ray, hit, report.normal());
    }
    return chunk.door(place.strand).blocks(h, opacity);
  }

  /// Where a ray leaves a round strand. The crossing was counted on entry.
  static bool is_exit(const EmbreeChunk& chunk, const EmbreeReport& report) {
    return chunk.options_.shape == CurveShape::kRound && report.faces_away();
  }
};

EmbreeChunk::EmbreeChunk(ChunkContents contents, uint32_t number, float widest,
                         const EmbreeChunkOptions& options, const EmbreeDevice& device,
                         SegmentPatterns& patterns)
    : options_(options), device_(device), part_(contents.part), number_(number) {
  size_t held = sizeof(*this);
  if (auto* fur = std::get_if<FurContents>(&contents.geometry)) {
    before_ = begins_before(widest, options.shape);
    // Freed before the tree is built, so that both never coexist.
    const FurContents grown = std::move(*fur);
    longest_ = longest_segment(grown.strands, options.shape);
    strands_.emplace(grown.strands, grown.opacity, options.compact_attributes, patterns);
    held += strands_->bytes() - sizeof(PackedStrands);
  } else {
    skin_ = std::move(std::get<SkinMesh>(contents.geometry));
    pad_for_embree(skin_.positions);
    add_triangle_boxes();
    held += skin_.bytes() + triangle_boxes_.capacity() * sizeof(triangle_boxes_[0]);
  }
  {
    const auto lock = device_.one_at_a_time();
    const EmbreeMeter meter;
    Workers::alone().run_library([&] {
      // Embree uses only the calling thread here.
      const FlushDenormals flush;
      build();
    });
    build_peak_ = held + static_cast<size_t>(meter.peak());
    held += static_cast<size_t>(meter.held());
  }
  bytes_ = held;
  try {
    device_.rethrow_of_thread();
  } catch (...) {
    rtcReleaseScene(scene_);
    throw;
  }
}

EmbreeChunk::~EmbreeChunk() {
  const auto lock = device_.one_at_a_time();
  rtcReleaseScene(scene_);
}

bool EmbreeChunk::closest(const Ray& ray, FurRays&, NearestSoFar& nearest, HitGeometry& hit_geometry) const {
  RTCRayHit r;
  Ray here = ray;
  // A hit as near as the nearest so far may precede it: allow for rounding.
  here.far = std::min(ray.far, far_behind(nearest.hit.distance, longest_));
  r.ray = embree_ray(here, before_);
  if (before_ > 0) r.ray.tfar = std::nextafter(r.ray.tfar, std::numeric_limits<float>::infinity());
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  const bool through_door = sees_door(ray);
  NearestQuery query(opaque()       ? Filters::keep_nearest
                     : through_door ? Filters::keep_nearest_at_door
                                    : Filters::keep_nearest_stopping,
                     *this, ray, nearest);
  embree_intersect(scene_, query, r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  nearest = Filters::place_of(*this, r.hit.primID);
  Hit& hit = nearest.hit;
  hit.distance = query.distance;
  hit.u = r.hit.u;
  if (!strands_) {
    hit.v = r.hit.v;
    hit_geometry.triangle.assign_triangle(skin_, r.hit.primID);
    return true;
  }
  hit.v = -r.hit.v;  // Embree's sign convention is opposite
  const uint32_t strand = strands_->locate(r.hit.primID).strand;
  hit.start = start_on(strand, static_cast<float>(hit.segment) + hit.u);
  hit.strand_index = strand;
  strands_->copy_strand(strand, hit_geometry.strand);
  if (v_is_no_offset()) {
    const V3f normal(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
    hit.v = offset_across(hit_geometry.strand, options_.shape == CurveShape::kRound, ray, hit, normal);
  }
  if (through_door)
    hit.v = door(strand).offset_inside(hit.v, strands_->opacity({strand, hit.segment}, hit.u));
  return true;
}

bool EmbreeChunk::v_is_no_offset() const {
  return options_.shape == CurveShape::kRound || strands_->basis() == CurveBasis::kLinear;
}

ScreenDoor EmbreeChunk::door(uint32_t strand) const { return ScreenDoor(strands_->id(strand), part_); }

bool EmbreeChunk::visit_primitives(const Beam& beam, PrimitiveSink& sink) const {
  if (strands_) return false;
  const size_t count = skin_.triangle_count(), vertices = skin_.vertex_count();
  std::vector<V3f> corners(3 * static_cast<size_t>(skin_.motion_keys));
  for (size_t box = 0; box < triangle_boxes_.size(); ++box) {
    float entry = 0;
    if (!beam.meets(triangle_boxes_[box], sink.far(), entry)) continue;
    const size_t end = std::min(count, (box + 1) * kTrianglesPerBox);
    for (size_t triangle = box * kTrianglesPerBox; triangle < end; ++triangle) {
      for (size_t i = 0; i < corners.size(); ++i) {
        const float* p = &skin_.positions[(i / 3 * vertices + skin_.triangles[3 * triangle + i % 3]) * 3];
        corners[i] = V3f(p[0], p[1], p[2]);
      }
      sink.triangle(static_cast<uint32_t>(triangle), corners);
    }
  }
  return true;
}

bool EmbreeChunk::stops(uint32_t random, uint32_t primitive, float u) const {
  if (opaque()) return true;
  const PackedStrands::Place place = strands_->locate(primitive);
  return stops_at(random, crossing(place, u), strands_->opacity(place, u));
}

bool EmbreeChunk::collect(const Ray& ray, FurRays&, Crossings& crossings) const {
  RTCRay r = embree_ray(ray, before_);
  const bool counts = strands_ && crossings.counts();
  const bool asks = counts || !opaque() || starts_here(ray);
  const auto ask = counts           ? Filters::count_crossings
                   : sees_door(ray) ? Filters::block_at_door
                                    : Filters::collect_crossings;
  LightQuery query(asks ? ask : nullptr, *this, ray, crossings);
  embree_occluded(scene_, query, r);
  return r.tfar >= 0;
}

bool EmbreeChunk::is_start(const Ray& ray, uint32_t primitive, float u, float distance) const {
  if (primitive - ray.start.first_segment >= ray.start.segment_count) return false;
  if (before_ > 0 && distance > 4 * before_) return false;  // much more than two widths
  const PackedStrands::Place place = strands_->locate(primitive);
  Strands strand;
  strands_->copy_strand(place.strand, strand);
  return pelage::is_start(strand, ray, place.segment, u, distance);
}

CrossingPlace EmbreeChunk::crossing(PackedStrands::Place place, float u) const {
  return {strands_->id(place.strand), part_, place.segment + joint_beside(u, kTessellationRate)};
}

size_t EmbreeChunk::bytes_bound(const ChunkCounts& n) {
  return bytes_bound(
      n, sizeof(EmbreeChunk) + skin_bytes_bound(n) + PackedStrands::bytes_bound(n) + tree_bytes_bound(n) +
             reference_bytes_bound(n.segments + n.triangles, static_cast<size_t>(n.motion_keys) - 1));
}

size_t EmbreeChunk::bytes_bound(const ChunkCounts& n, size_t build_peak) {
  const auto keys = static_cast<size_t>(n.motion_keys);
  const size_t grown = 16 * keys * n.points + n.strands * (sizeof(uint32_t) + sizeof(uint64_t)) +
                       n.strands * (sizeof(RootAddress) + sizeof(V2f)) +
                       sizeof(float) * (n.points + n.attribute_floats) + kPerScene;
  // Positions may be copied for padding.
  const size_t packing =
      PackedStrands::bytes_bound(n) + PackedStrands::scratch_bytes_bound(n) + 12 * keys * n.vertices;
  return std::max(sizeof(EmbreeChunk) + skin_bytes_bound(n) + grown + std::max(packing, n.growth_bytes),
                  build_peak);
}

}  // namespace pelage
