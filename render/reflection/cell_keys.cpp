// SPDX-License-Identifier: Apache-2.0
#include "render/reflection/cell_keys.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "base/hash.h"
#include "lod/lod_view.h"
#include "render/frame/rest_place.h"

namespace pelage {
namespace {

constexpr int kMinKeyExponent = -60, kMaxKeyExponent = 60;
constexpr uint32_t kMaxParts = 128;
constexpr uint32_t kOutside = 0, kInside = 1;  // of a skin; parts of strands have numbers from 4 on
constexpr int kSizes[] = {0, 1, 3};  // binary logarithms of the sides of cells / side of the smallest

float length_of_polygon(const Strands& strand) {
  float length = 0;
  for (uint32_t i = 1; i < strand.strand_points(0); ++i)
    length += (strand.point(i) - strand.point(i - 1)).length();
  return length;
}

/// Where a strand is hit, between 0 at its root and 1 at its tip.
float place_on_strand(const Hit& hit, const Strands& strand) {
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  return (static_cast<float>(hit.segment) + hit.u) / static_cast<float>(segments);
}

/// A number that identifies the part of a strand that contains `place`, among the parts of all lengths; not
/// 0. `pixels`: length of the strand in the picture.
uint32_t part_of_strand(float place, float pixels, int level) {
  uint32_t parts = CellKeys::kMinParts;
  while (parts < kMaxParts && pixels > static_cast<float>(parts << level) * CellKeys::kPartPixels) parts *= 2;
  return parts + std::min(static_cast<uint32_t>(static_cast<float>(parts) * place), parts - 1);
}

/// Whether a ray hits a skin from the side from which its triangles turn clockwise.
bool is_behind(const SkinMesh& triangle, const Ray& ray) {
  const V3f& a = triangle.position(0);
  return (triangle.position(1) - a).cross(triangle.position(2) - a).dot(ray.direction) > 0;
}

uint32_t octant_of(const V3f& direction) {
  return (direction.x < 0 ? 1u : 0u) | (direction.y < 0 ? 2u : 0u) | (direction.z < 0 ? 4u : 0u);
}

}  // namespace

std::optional<CellPath> CellKeys::of(const Ray& ray, const Hit& hit, const HitGeometry& hit_geometry) const {
  const bool on_strand = hit.kind == HitKind::kStrand;
  if (!on_strand && std::holds_alternative<GlossyParams>(scene_.materials[scene_.skins[hit.part].material]))
    return std::nullopt;
  const RestPlace at = on_strand ? rest_place(scene_.fur[hit.part], hit_geometry.strand)
                                 : rest_place(scene_.skins[hit.part], ray, hit, hit_geometry.triangle);
  const V3f seen = on_strand ? hit_geometry.strand.point(0) : ray.origin + hit.distance * ray.direction;
  const float pixels = at.scale * pixels_per_unit(view_, seen);
  const int exponent = std::clamp(std::ilogb(kPixels / pixels), kMinKeyExponent, kMaxKeyExponent);
  const float length = on_strand ? length_of_polygon(hit_geometry.strand) * pixels_per_unit(view_, seen) : 0;
  const float place = on_strand ? place_on_strand(hit, hit_geometry.strand) : 0;
  const uint32_t skin = !on_strand && is_behind(hit_geometry.triangle, ray) ? kInside : kOutside;
  const uint64_t coat =
      hash64(random_use("cell of reflections"), hit.part, side_of(at.normal), octant_of(ray.direction));
  CellPath cells;
  for (int level = 0; level < static_cast<int>(cells.size()); ++level) {
    const auto index = [&](int axis) {
      const double scaled = std::ldexp(double{at.position[axis]}, -(exponent + kSizes[level]));
      return static_cast<uint64_t>(static_cast<int64_t>(std::floor(scaled)));
    };
    const uint32_t part = on_strand ? part_of_strand(place, length, level) : skin;
    cells[static_cast<size_t>(level)] = hash64(coat, part, static_cast<uint32_t>(exponent),
                                               static_cast<uint32_t>(level), index(0), index(1), index(2));
  }
  return cells;
}

}  // namespace pelage
