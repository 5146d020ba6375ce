// SPDX-License-Identifier: Apache-2.0
#include "render/frame/frame_shading.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "base/error.h"
#include "base/hash.h"
#include "geom/root_detail.h"
#include "geom/strand_point.h"
#include "render/frame/skin_point.h"
#include "render/frame/skin_shadows.h"
#include "render/frame/strand_fields.h"

namespace pelage {
namespace {

/// Position over the whole strand of a position in one of its segments.
float along_strand(const Strands& strand, const Hit& hit) {
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  return (static_cast<float>(hit.segment) + hit.u) / static_cast<float>(segments);
}

/// A position across a fibre that is independent of the hit: samples the far field.
float random_offset(const Hit& hit) {
  return signed_float(hash64(random_use("far field"), hit.strand_id, hit.segment,
                             std::bit_cast<uint32_t>(hit.u), std::bit_cast<uint32_t>(hit.v)));
}

std::optional<Rgb> constant_of(const Field& field) {
  return field.is_constant() ? std::optional(field.color({})) : std::nullopt;
}

// Max distance along a fibre, in radii, from the point where a ray passes the axis to the point where it is
// assumed to enter. For inclinations beyond 83 degrees, the distance would be so long that the fibre is not a
// straight cylinder over it.
constexpr float kFarthestEntry = 8;

/// Distance along the tangent, in radii, from the nearest point to the axis to where a ray entered the
/// fibre's surface.
float entry_place(const FibrePoint& at, float h) {
  const FibreFrame frame(at.tangents[0], at.wo);
  const float slant = frame.sin_theta_o() / frame.cos_theta_o();
  return std::clamp(std::sqrt(std::max(0.0f, 1 - h * h)) * slant, -kFarthestEntry, kFarthestEntry);
}

// Distance from the root, in radii, from which on the skin does not cut into a strand, unless it lies flatter
// than two degrees.
constexpr float kNearRoot = 32;

/// A point of a strand at a shutter time, on the straight line between its positions at open and close.
V3f position_at(const Strands& strand, size_t point, float time) {
  const V3f open = strand.point(point);
  return open + time * (strand.point(point, strand.motion_keys() - 1) - open);
}

// Height above the skin at which light starts that leaves it beside the hit, relative to the distance: facets
// protrude from the surface that they approximate.
constexpr float kSkinRise = 0.08f;

/// Random numbers that depend on the visible object and the line of sight, but not on the position of the
/// hit: small changes between frames must not change the random choice.
class ViewRandom {
 public:
  ViewRandom(const Ray& ray, uint64_t seen) : ray_(ray), seen_(seen) {}
  float number(uint64_t use) const {
    return unit_float(hash64(use, seen_, bits(0), bits(1) << 32 | bits(2)));
  }
  /// A uniformly distributed point of a disc around the origin, on a skin with this normal.
  V3f on_skin(const V3f& normal, float radius) const {
    const V3f side = normal.cross(std::abs(normal.x) < 0.5f ? V3f(1, 0, 0) : V3f(0, 1, 0)).normalized();
    const float angle = 2 * std::numbers::pi_v<float> * number(random_use("deputy: angle"));
    const float distance = radius * std::sqrt(number(random_use("deputy: distance")));
    return distance * (std::cos(angle) * side + std::sin(angle) * normal.cross(side));
  }

 private:
  uint64_t bits(int i) const { return std::bit_cast<uint32_t>(ray_.direction[i]); }

  const Ray& ray_;
  uint64_t seen_;
};

/// One of the strands that a strand with reduced detail represents, from which light continues. If light
/// continued from the wide strand itself, its path would be as unobstructed as the line of sight: the space
/// of the omitted strands would count as empty.
struct RepresentedStrand {
  V3f away{0};
  bool can_hit_own_strand = false;
};

RepresentedStrand represented_strand(const Simplification& lod, float share, const Ray& ray, const Hit& hit,
                                     const Strands& strand) {
  RepresentedStrand represented;
  const std::optional<RootDetail> detail = RootDetail::of(strand, 0);
  const float spread = lod.spread(share);
  if (!detail || !(spread > 0)) return represented;
  const ViewRandom random(ray, hit.strand_id);
  represented.away = random.on_skin(detail->normal(), spread);
  represented.can_hit_own_strand = random.number(random_use("deputy: own")) < lod.own_shadow(share);
  return represented;
}

/// Not lighter than white, unless the colour itself is.
Rgb tinted(const Rgb& color, const Rgb& tint) {
  Rgb result;
  for (int i = 0; i < 3; ++i) result[i] = std::min(color[i] * tint[i], std::max(color[i], 1.0f));
  return result;
}

}  // namespace

FrameShading::FrameShading(const FrameScene& scene, const SkinShadows* balls)
    : scene_(scene), balls_(balls), fibres_(scene.materials.size()), skins_(scene.materials.size()) {
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (const FibreParams* fibre = fibre_params(scene.materials[i])) {
      fibres_[i].emplace(Fibre{FibreMaterial(scene.materials[i]), std::nullopt, fibre->color,
                               constant_of(fibre->color), fibre->color.attribute_names()});
      if (scene.render.indirect == IndirectLight::kDual) fibres_[i]->averages.emplace(fibres_[i]->material);
    } else if (const auto* lambert = std::get_if<LambertParams>(&scene.materials[i])) {
      skins_[i] = Skin{lambert->color, constant_of(lambert->color), std::nullopt};
    } else if (const auto* glossy = std::get_if<GlossyParams>(&scene.materials[i])) {
      skins_[i] = Skin{glossy->color, constant_of(glossy->color), *glossy};
    }
  }
  for (const SkinPart& part : scene.skins) {
    if (!skins_.at(part.material))
      throw Error(ErrorKind::kInput, part.name + ": its material is not for skins");
  }
}

Rgb FrameShading::fibre_color(const Fibre& fibre, const Strands& strand, const Hit& hit, float v) const {
  if (fibre.constant_color) return *fibre.constant_color;
  std::array<const StrandAttribute*, kMaxFieldAttributes> attributes;
  for (size_t i = 0; i < fibre.attributes.size(); ++i)
    attributes[i] = strand.find_attribute(fibre.attributes[i]);
  return strand_color(fibre.color, strand, std::span(attributes).first(fibre.attributes.size()),
                      scene_.fur[hit.part].rest.get(), {0, hit.segment, hit.u, v});
}

float FrameShading::kept_share(const Hit& hit, const Strands& strand) const {
  const std::optional<Simplification>& lod = scene_.fur[hit.part].lod;
  if (!lod) return 1;
  if (const std::optional<RootDetail> detail = RootDetail::of(strand, 0)) return detail->share();
  return lod->share({.open = strand.point(0), .close = strand.point(0, strand.motion_keys() - 1)});
}

ScatterPoint FrameShading::fibre_point(const Ray& ray, const Hit& hit, const Strands& strand) const {
  const Fibre& fibre = *fibres_[scene_.fur[hit.part].material];
  const StrandPoint point = strand_point(strand, 0, hit.segment, hit.u, ray.time);
  const float v = along_strand(strand, hit);

  FibrePoint at;
  at.tangents.fill(point.tangent);
  if (const ConeShellMaterial* shells = fibre.material.cone_shell()) {
    for (LobeGroup lobe : {LobeGroup::kPrimary, LobeGroup::kSecondary}) {
      const float place = shells->tangent_place(lobe, v, hit.strand_id, 0);
      at.tangents[static_cast<size_t>(lobe)] = strand_tangent(strand, 0, place, ray.time);
    }
  }
  at.wo = -ray.direction;
  at.h = fibre.material.far_field() ? random_offset(hit) : std::clamp(hit.v, -1.0f, 1.0f);
  at.color = tinted(fibre_color(fibre, strand, hit, v), scene_.fur[hit.part].tint);
  const FibreBsdf bsdf = fibre.material.at(at);
  const auto finished = [&](ScatterPoint result) {
    if (fibre.averages) result.set_dual({*fibre.averages, point.tangent, at.wo, at.color});
    return result;
  };
  const std::optional<Simplification>& lod = scene_.fur[hit.part].lod;
  const float share = lod ? kept_share(hit, strand) : 1.0f;
  if (share < 1) {
    RepresentedStrand represented = represented_strand(*lod, share, ray, hit, strand);
    // At the height in the coat where the line of sight hit the wide strand rather than its axis: seen from
    // the side, a coat shows the upper edges of wide strands.
    const float beside_axis = 1 - 1 / lod->gain(share);
    represented.away += beside_axis * (ray.origin + hit.distance * ray.direction - point.position);
    return finished({point.position, point.tangent, point.radius / lod->gain(share), represented.away,
                     represented.can_hit_own_strand, at.h, bsdf});
  }
  // Flat strands are hit where the ray is nearest to the axis, round ones where it enters.
  const float entry = scene_.render.curves == CurveShape::kFlat ? entry_place(at, hit.v) : 0.0f;
  return finished({point.position, point.tangent, point.radius, ray.origin + hit.distance * ray.direction,
                   at.h, bsdf, point.radius * (entry + fibre.material.farther(at))});
}

Rgb FrameShading::skin_color(const SkinPart& part, const Skin& skin, const Hit& hit,
                             const SkinMesh& triangle) const {
  if (skin.constant_color) return *skin.constant_color;
  FieldPoint point;
  if (part.rest) {
    const uint32_t face = triangle.faces[0];
    const V2f place = skin_parameters(triangle, hit);
    const V2f uv = part.rest->topology().texture_coordinates(face, place.x, place.y);
    point.u = uv.x;
    point.v = uv.y;
    point.face = face;
    point.face_uv = place;
    const FieldDependence needs = skin.color.dependence();
    if (needs.surface) {
      const SurfacePoint at = part.rest->evaluate(face, place.x, place.y);
      point.rest = at.position;
      if (needs.normal) point.normal = part.rest->frame(at, face, place.x, place.y).normal;
    }
  }
  return skin.color.color(point);
}

ScatterPoint FrameShading::skin_point(const Ray& ray, const Hit& hit, const SkinMesh& triangle) const {
  const SkinPart& part = scene_.skins[hit.part];
  const Skin& skin = *skins_[part.material];
  SkinPoint point = pelage::skin_point(triangle, ray, hit);
  const Rgb color = tinted(skin_color(part, skin, hit, triangle), part.tint);
  if (part.lod) {
    // From a point beside the hit; otherwise light would follow the line of sight through the gaps of wide
    // strands.
    const V3f open = point.position - ray.time * point.shutter_motion;
    const float share =
        part.lod->share({.open = open, .close = open + point.shutter_motion, .normal = point.normal});
    V3f away = ViewRandom(ray, hit.part).on_skin(point.normal, part.lod->spread(share));
    const float rise = skin_rise(triangle, ray.time, point.normal, away);
    away += (rise + kSkinRise * away.length()) * point.normal;
    point.position += away;
    point.start += away;
  }
  if (!skin.coat) return {point.position, point.start, LambertBsdf(color, point.normal)};
  return {point.position, point.start,
          GlossyBsdf(color, skin.coat->roughness, skin.coat->ior, point.normal, -ray.direction)};
}

/// Tells a point near the root of its strand where the skin is.
void FrameShading::set_skin(const Ray& ray, const Hit& hit, const Strands& strand,
                            ScatterPoint& point) const {
  const std::shared_ptr<const DeferredSkin>& skin = scene_.fur[hit.part].follows;
  if (!skin || !strand.has_roots()) return;
  const V3f root = position_at(strand, 0, ray.time);
  const float near = kNearRoot * point.exit().radius;
  if ((ray.origin + hit.distance * ray.direction - root).length2() > near * near) return;
  if (const std::optional<V3f> normal = skin->normal(strand.root(0))) point.set_skin(root, *normal);
}

ScatterPoint FrameShading::scatter_point(const Ray& ray, const Hit& hit,
                                         const HitGeometry& hit_geometry) const {
  ScatterPoint point = hit.kind == HitKind::kStrand ? fibre_point(ray, hit, hit_geometry.strand)
                                                    : skin_point(ray, hit, hit_geometry.triangle);
  if (hit.kind == HitKind::kStrand) set_skin(ray, hit, hit_geometry.strand, point);
  if (!scene_.magnets.empty()) point.set_magnets(scene_.magnets);
  point.set_part({hit.kind == HitKind::kSkin, hit.part});
  if (balls_) point.set_shadow(balls_->below(hit, hit_geometry, ray.time));
  return point;
}

Rgb FrameShading::color(const Hit& hit, const HitGeometry& hit_geometry) const {
  if (hit.kind == HitKind::kStrand) {
    const FurPart& part = scene_.fur[hit.part];
    const Rgb color = fibre_color(*fibres_[part.material], hit_geometry.strand, hit,
                                  along_strand(hit_geometry.strand, hit));
    return tinted(color, part.tint);
  }
  const SkinPart& part = scene_.skins[hit.part];
  return tinted(skin_color(part, *skins_[part.material], hit, hit_geometry.triangle), part.tint);
}

/// Motion in pixels from the frame to the next one for a point seen at `time` of the shutter.
/// `shutter_motion`: from its first to its last motion key. `next(now)`: where the point will be at the next
/// frame; empty if only the motion keys are known, whose mean motion it then continues. The camera follows
/// its keys.
template <class Next>
V2f FrameShading::motion_in_image(const V3f& position, const V3f& shutter_motion, float time,
                                  const Next& next) const {
  const Camera& camera = scene_.camera;
  const bool open = camera.shutter_frames() > 0;
  V3f now = position;
  if (open) now += shutter_motion * (camera.frame_time() - time);
  // If the shutter is closed, the motion keys span one frame.
  const std::optional<V3f> there = next(now);
  const V3f per_frame = there ? *there - now : shutter_motion / (open ? camera.shutter_frames() : 1.0f);
  if (!open) now -= camera.shutter_open() * per_frame;
  const auto from = camera.project_at_frame(now, 0);
  const auto to = camera.project_at_frame(now + per_frame, 1);
  if (!from || !to) return V2f(0);
  return {to->x - from->x, to->y - from->y};
}

float FrameShading::depth(const Ray& ray, const Hit& hit) const {
  const V3f position = ray.origin + hit.distance * ray.direction;
  return (position - scene_.camera.position(ray.time)).dot(scene_.camera.axis(ray.time));
}

VisibleSurface FrameShading::visible_surface(const Ray& ray, const Hit& hit,
                                             const HitGeometry& hit_geometry) const {
  VisibleSurface surface;
  const V3f position = ray.origin + hit.distance * ray.direction;
  surface.depth = depth(ray, hit);
  if (hit.kind == HitKind::kSkin) {
    const SkinPart& part = scene_.skins[hit.part];
    const SkinPoint point = pelage::skin_point(hit_geometry.triangle, ray, hit);
    surface.normal = point.normal;
    const V2f place = skin_parameters(hit_geometry.triangle, hit);
    const RootAddress at{hit_geometry.triangle.faces[0], place.x, place.y};
    if (part.rest) surface.root_uv = part.rest->topology().texture_coordinates(at.face, at.u, at.v);
    const std::optional<SurfaceStep> step = part.skin->step(&at);
    surface.forward = motion_in_image(position, point.shutter_motion, ray.time, [&](const V3f& now) {
      return step ? std::optional(step->moved(now)) : std::nullopt;
    });
    return surface;
  }
  const Strands& strand = hit_geometry.strand;
  surface.tangent = strand_point(strand, 0, hit.segment, hit.u, ray.time).tangent;
  // The normal of a circular fibre at h, from the frame of the fibre and the ray.
  const V3f across = surface.tangent.cross(-ray.direction);
  const float length = across.length();
  if (length > 1e-6f) {
    const V3f ez = across / length;
    const V3f ey = ez.cross(surface.tangent);
    surface.normal = std::sqrt(std::max(0.0f, 1 - hit.v * hit.v)) * ey - hit.v * ez;
  } else {
    surface.normal = -ray.direction;
  }
  V3f motion(0);
  const V3f root = position_at(strand, 0, scene_.camera.frame_time());
  if (strand.motion_keys() > 1) {
    motion = strand_point(strand, 0, hit.segment, hit.u, 1).position -
             strand_point(strand, 0, hit.segment, hit.u, 0).position;
  }
  const std::shared_ptr<const DeferredSkin>& follows = scene_.fur[hit.part].follows;
  const auto step = follows ? follows->step(strand.has_roots() ? &strand.root(0) : nullptr) : std::nullopt;
  surface.forward = motion_in_image(position, motion, ray.time, [&](const V3f& now) {
    return step ? std::optional(step->moved(now, root)) : std::nullopt;
  });
  surface.root_uv = strand.root_uv(0);
  surface.id = static_cast<uint32_t>(hit.strand_id);
  surface.left_out = 1 - kept_share(hit, strand);
  return surface;
}

}  // namespace pelage
