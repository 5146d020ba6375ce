// SPDX-License-Identifier: Apache-2.0
#include "world/scene_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "rib/scene/rib_reading.h"

namespace pelage {
namespace {

// Up to this many widths from the origin, rounding the points of strands to floats changes the mean of a
// picture by less than 0.3 % (measured with coats at 1e2 to 1e6 times their size).
constexpr float kFineWidths = 0x1p16f;
// The warnings: floats near the coat are farther apart than this fraction of its radius. A camera that is
// rounded by half of that, at four radii from the coat, changes the area of the coat by up to 0.3 %. If the
// vertices of its mesh are rounded, so are its normals.
constexpr float kCoarseStep = 1.0f / 64, kCoarseVertices = 1.0f / 256;

float largest(const Box3f& box) {
  float max = 0;
  for (const V3f& p : {box.min, box.max}) max = std::max({max, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return max;
}

/// A part of a character that has a coat.
struct Coat {
  const FrameCharacter* character = nullptr;
  size_t part = 0;
  Box3f box;  // of the cage

  const PartParams& params() const { return character->params->parts[part]; }
  float scale(double frame) const {
    const float own = character->params->transform.scale.at(frame);
    return character->member ? own * max_component(character->member->scale) : own;
  }
};

std::optional<Coat> nearest_coat(const Assets& assets, const std::vector<FrameCharacter>& characters,
                                 const V3f& eye, double frame) {
  std::optional<Coat> nearest;
  float min = std::numeric_limits<float>::infinity();
  for (const FrameCharacter& character : characters) {
    for (size_t part = 0; part < character.params->parts.size(); ++part) {
      if (character.params->parts[part].grooms.items.empty()) continue;
      const Box3f box = approximate_box(character, part, assets, frame);
      const float distance = (box.center() - eye).length();
      if (!(distance < min)) continue;
      min = distance;
      nearest = Coat{&character, part, box};
    }
  }
  return nearest;
}

/// Returns the origin for a coat of this approximate position and width of its strands.
V3f origin_near(const V3f& coat, float width) {
  const float reach = largest({coat, coat});
  if (!(width > 0) || !std::isfinite(reach) || reach <= kFineWidths * width) return V3f(0);
  const float step = std::exp2(std::floor(std::log2(kFineWidths / 4 * width)));
  V3f origin;
  for (int axis = 0; axis < 3; ++axis) origin[axis] = std::round(coat[axis] / step) * step;
  return origin;
}

/// Returns the origin for the strands of RIB files, which are read for it.
V3f archive_origin(const SceneDescription& scene, Assets& assets, const V3f& eye, double frame,
                   const Job& job) {
  StrandScale nearest;
  float min = std::numeric_limits<float>::infinity();
  for (const auto& [name, position, params] : scene.archives.items) {
    Archive& archive = assets.archives[name];
    load_archive(scene, name, params, frame, job, V3f(0), archive);
    for (const RibCoat& coat : archive.rib->coats) {
      if (coat.batches.empty() && coat.deferred.empty()) continue;
      const StrandScale scale = rib_procedural(coat)->scale();
      const float distance = (scale.anchor - eye).length();
      if (!(distance < min)) continue;
      min = distance;
      nearest = scale;
    }
  }
  return origin_near(nearest.anchor, nearest.width);
}

}  // namespace

V3f scene_origin(const SceneDescription& scene, Assets& assets, const std::vector<FrameCharacter>& characters,
                 const V3f& eye, double frame, const Job& job) {
  const std::optional<Coat> coat = nearest_coat(assets, characters, eye, frame);
  if (!coat) return archive_origin(scene, assets, eye, frame, job);
  float width = std::numeric_limits<float>::infinity();
  for (const auto& groom : coat->params().grooms.items)
    width = std::min(width, assets.grooms.at(groom.name)->width() * coat->scale(frame));
  return origin_near(coat->box.center(), width);
}

std::optional<std::string> coarse_position(const SceneDescription& scene, const Assets& assets,
                                           double frame) {
  const std::vector<FrameCharacter> characters = frame_characters(scene, assets);
  const std::optional<Coat> coat = nearest_coat(assets, characters, scene.camera.position.at(frame), frame);
  if (!coat) return {};
  const std::string& skin = coat->params().skin.name;
  const float in_file = largest(assets.skins.at(skin).rest->control_bounds()) * coat->scale(frame);
  const float in_scene = largest(coat->box), reach = std::max(in_scene, in_file);
  const float radius = 0.5f * coat->box.size().length(), step = reach * std::numeric_limits<float>::epsilon();
  const float max = in_file < reach ? kCoarseStep : kCoarseVertices;
  if (!std::isfinite(reach) || !(step > max * radius)) return {};
  return fmt::format(
      "{} is {:.2g} units from the origin{}, where coordinates are rounded to multiples of about {:.1g} "
      "units, "
      "{:.2g} % of its size: move {} nearer to the origin",
      coat->character->name, reach, in_file < reach ? "" : " of its mesh file", step, 50 * step / radius,
      in_file < reach ? "the scene" : "the mesh");
}

}  // namespace pelage
