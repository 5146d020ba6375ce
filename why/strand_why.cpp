// SPDX-License-Identifier: Apache-2.0
#include "why/strand_why.h"

#include <algorithm>

#include "base/check.h"
#include "geom/rest_position.h"
#include "geom/strand_point.h"
#include "groom/groom.h"
#include "procedurals/fur.h"

namespace pelage {
namespace {

constexpr uint32_t kPiecesOfSegment = 8;  // straight pieces that measure its length

/// A strand of a coat, and the skin on which it grows.
struct Grown {
  const FurProcedural& coat;
  size_t follicle;
  std::shared_ptr<const SkinPose> pose;
};

Grown find_strand(const FurPart& part, uint64_t id) {
  PELAGE_CHECK(part.procedurals.size() == 1);
  const auto* coat = dynamic_cast<const FurProcedural*>(part.procedurals.front().get());
  PELAGE_CHECK(coat);
  const FollicleTree& follicles = coat->groom().follicles();
  size_t follicle = 0;
  while (follicle < follicles.size() && follicles.id(follicle) != id) ++follicle;
  PELAGE_CHECK(follicle < follicles.size());
  const PosedCharacterSkin& skin = coat->skin();
  if (coat->groom().needs_closest_point()) return {*coat, follicle, skin.pose(BoundSpan::kShutter)};
  std::vector<uint32_t> faces;
  if (coat->groom().grows_on_skin()) faces.push_back(follicles.root(follicle).face);
  return {*coat, follicle, std::make_shared<const SkinPose>(skin.pose(BoundSpan::kShutter, faces))};
}

/// Name of the groom of a coat "character.groom".
const Named<GroomParams>::Item& groom_of(const SceneDescription& scene, const Assets& assets,
                                         const Groom& groom) {
  for (const auto& item : scene.grooms.items) {
    if (assets.grooms.at(item.name).get() == &groom) return item;
  }
  PELAGE_CHECK(false);
  return scene.grooms.items.front();
}

std::vector<StepWhy> steps_of(const Groom& groom, const Grown& strand) {
  std::vector<StepWhy> steps;
  for (GrowthStep& step : groom.grow_steps(strand.follicle, strand.pose->skin()))
    steps.push_back({std::move(step.name), strand_places(step.strand)});
  return steps;
}

std::vector<StepWhy> explain_steps(const SceneDescription& scene, Assets& assets, const Grown& strand,
                                   const Job& job) {
  const Groom& groom = strand.coat.groom();
  const auto& [name, position, params] = groom_of(scene, assets, groom);
  if (!params.cache) return steps_of(groom, strand);
  GroomParams plain = params;
  plain.leaf_strands = params.leaf_size();  // so that the follicles are the same
  plain.cache.reset();
  const auto skin = assets.skins.find(params.skin.name);
  const auto rest = skin == assets.skins.end() ? nullptr : skin->second.rest;
  return steps_of(*Groom::create(name, plain, rest, assets.textures, job, &groom), strand);
}

std::optional<LodWhy> explain_lod(const Grown& strand) {
  const CoatDetail* detail = strand.coat.detail();
  if (!detail) return {};
  const Simplification& lod = detail->simplification();
  const RootPlace root = detail->place(strand.follicle, *strand.pose);
  LodWhy why;
  why.measures = lod.measures(root);
  why.priority = strand.coat.groom().priority(strand.follicle);
  why.fade = Simplification::fade(why.measures.share, why.priority);
  why.width = lod.width_factor(why.measures.share, why.priority);
  why.contrast = lod.contrast(why.measures.share);
  why.tolerance = why.measures.share < 1 ? lod.tolerance(root.open) : 0.0f;
  return why;
}

std::vector<V2f> outline_of(const Strands& strand, const Camera& camera, float time) {
  constexpr uint32_t kPieces = 8;  // of a segment
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  std::vector<V2f> outline;
  for (uint32_t i = 0; i <= segments * kPieces; ++i) {
    const uint32_t segment = std::min(i / kPieces, segments - 1);
    const float t = static_cast<float>(i - segment * kPieces) / kPieces;
    const auto at = camera.project(strand_point(strand, 0, segment, t, time).position, time);
    if (at) outline.emplace_back(at->x, at->y);
  }
  return outline;
}

}  // namespace

StrandPlaces strand_places(const Strands& strand) {
  const uint32_t segments = segment_count(strand.basis(), strand.strand_points(0));
  StrandPlaces places;
  const StrandAttribute* color = strand.find_attribute("color");
  if (color && color->components == 3) places.color.emplace();
  for (size_t i = 0; i < places.position.size(); ++i) {
    const float along = 0.5f * static_cast<float>(i) * static_cast<float>(segments);
    const uint32_t segment = std::min(static_cast<uint32_t>(along), segments - 1);
    const float t = along - static_cast<float>(segment);
    const StrandPoint point = strand_point(strand, 0, segment, t, 0);
    places.position[i] = point.position;
    places.width[i] = 2 * point.radius;
    if (places.color) interpolate_attribute(strand, *color, 0, segment, t, &(*places.color)[i].x);
  }
  V3f last = places.position.front();
  for (uint32_t piece = 1; piece <= segments * kPiecesOfSegment; ++piece) {
    const uint32_t segment = (piece - 1) / kPiecesOfSegment;
    const float t = static_cast<float>(piece - segment * kPiecesOfSegment) / kPiecesOfSegment;
    const V3f at = strand_point(strand, 0, segment, t, 0).position;
    places.length += (at - last).length();
    last = at;
  }
  return places;
}

StrandWhy explain_strand(const SceneDescription& scene, Assets& assets, const RenderScene& frame,
                         const SeenSurface& surface, const Job& job) {
  const Hit& hit = surface.hit;
  const Strands& seen = surface.hit_geometry.strand;
  const FurPart& part = frame.fur[hit.part];
  const Grown strand = find_strand(part, hit.strand_id);
  StrandWhy why;
  why.coat = part.name;
  why.id = hit.strand_id;
  why.segment = hit.segment;
  const uint32_t segments = segment_count(seen.basis(), seen.strand_points(0));
  why.along = (static_cast<float>(hit.segment) + hit.u) / static_cast<float>(segments);
  why.across = hit.v;
  if (seen.has_roots()) why.root = seen.root(0);
  why.root_uv = seen.root_uv(0);
  why.rest = part.rest && why.root ? part.rest->evaluate(why.root->face, why.root->u, why.root->v).position
                                   : rest_position(seen, 0).value_or(seen.point(seen.first_point(0)));
  why.steps = explain_steps(scene, assets, strand, job);
  why.steps.push_back({"stored", strand_places(seen)});
  for (StepWhy& step : why.steps) {
    for (V3f& position : step.after.position) position += frame.origin;
  }
  why.lod = explain_lod(strand);
  why.outline = outline_of(seen, frame.camera, surface.ray.time);
  return why;
}

}  // namespace pelage
