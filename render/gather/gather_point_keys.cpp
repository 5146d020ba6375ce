// SPDX-License-Identifier: Apache-2.0
#include "render/gather/gather_point_keys.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/hash.h"
#include "render/frame/skin_point.h"
#include "render/gather/coat_cells.h"

namespace pelage {
namespace {

/// A strand whose gather points are seen by fewer samples uses the cells of its coat.
constexpr float kFewest = 4;

float distance(const std::optional<V3f>& a, const std::optional<V3f>& b) {
  return a && b ? V2f(b->x - a->x, b->y - a->y).length() : 0;
}

}  // namespace

GatherPointKeys::GatherPointKeys(const FrameScene& scene, uint32_t samples)
    : camera_(scene.camera),
      view_(scene.camera.lod_view()),
      params_(scene.render.gather),
      cells_(scene.camera, scene.fur, static_cast<float>(samples)) {}

GatherPointKey GatherPointKeys::of(const Hit& hit, const HitGeometry& hit_geometry, const V2f& random,
                                   RecentGatherPoints& recent) const {
  if (hit.kind != HitKind::kStrand) return on_skin(hit, hit_geometry.triangle, random);
  const StrandGatherPoints gather_points =
      recent.of(hit.key(), [&] { return gather_points_of(hit, hit_geometry.strand); });
  return on_strand(hit, hit_geometry.strand, gather_points, random);
}

StrandGatherPoints GatherPointKeys::gather_points_of(const Hit& hit, const Strands& strand) const {
  StrandGatherPoints gather_points;
  gather_points.length = camera_.projected_length(strand.points(), 0);
  gather_points.level = level_of(gather_points.length, params_.spacing);
  gather_points.in_cells =
      params_.cells &&
      cells_.samples_on(strand, std::ldexp(gather_points.length, -gather_points.level)) < kFewest;
  gather_points.patch = cells_.patch(hit, strand);
  return gather_points;
}

GatherPointKey GatherPointKeys::on_strand(const Hit& hit, const Strands& strand,
                                          const StrandGatherPoints& gather_points, const V2f& random) const {
  const int level = gather_points.level;
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  const float place = (static_cast<float>(hit.segment) + hit.u) / static_cast<float>(segments);
  const uint32_t gather_point = gather_point_near(place, level, random.x);
  const uint32_t zone = std::min(kZonesOfCoat * gather_point >> level, kZonesOfCoat - 1);
  const uint64_t coat = hash64(random_use("coat"), hit.part);
  // Pairs of gather points where these are shorter than a zone.
  const uint32_t part = (1u << level) > 2 * kZonesOfCoat ? kZonesOfCoat + gather_point / 2 : zone;
  const uint64_t patch = hash64(gather_points.patch, part);
  if (gather_points.in_cells) {
    const uint64_t bits = std::bit_cast<uint32_t>(random.y);
    return {cells_.key(hit, strand, gather_points.length, place, bits), patch, coat, zone, place};
  }
  return {hash64(random_use("knot of a strand"), hit.part, hit.strand_id, pack(level, gather_point)), patch,
          coat, zone, place};
}

GatherPointKey GatherPointKeys::on_skin(const Hit& hit, const SkinMesh& triangle, const V2f& random) const {
  const uint64_t skin = hash64(random_use("skin"), hit.part);
  if (triangle.vertex_uv.empty()) {
    const uint64_t face = triangle.faces.empty() ? 0 : triangle.faces[0];
    const uint64_t gather_point = hash64(random_use("knot of a skin"), hit.part, face);
    return {gather_point, gather_point, skin};
  }
  // The face's size in the picture along its two parameters, as it is at the hit: one end of a large face may
  // be behind the camera.
  const V2f* at = triangle.vertex_uv.data();
  const V2f e1 = at[1] - at[0], e2 = at[2] - at[0];
  const V3f& corner = triangle.position(0);
  const V3f d1 = triangle.position(1) - corner, d2 = triangle.position(2) - corner;
  const float area = e1.x * e2.y - e1.y * e2.x;
  int levels[2] = {0, 0};
  if (std::abs(area) > 0) {
    const V3f along[2] = {(d1 * e2.y - d2 * e1.y) / area, (d2 * e1.x - d1 * e2.x) / area};
    const V3f point = corner + hit.u * d1 + hit.v * d2;
    const auto from = camera_.project(point, 0);
    for (int i = 0; i < 2; ++i) {
      const float step = 1 / (along[i].length() * pixels_per_unit(view_, point));  // about a pixel
      const auto to = camera_.project(point + step * along[i], 0);
      levels[i] = level_of(distance(from, to) / step, params_.skin_spacing);
    }
  }
  const V2f place = skin_parameters(triangle, hit);
  const uint64_t gather_point = hash64(random_use("knot of a skin"), hit.part, triangle.faces[0],
                                       pack(levels[0], gather_point_near(place.x, levels[0], random.x)),
                                       pack(levels[1], gather_point_near(place.y, levels[1], random.y)));
  return {gather_point, gather_point, skin};
}

}  // namespace pelage
