// SPDX-License-Identifier: Apache-2.0
#include "world/frame_coats.h"

#include <algorithm>

#include "procedurals/detail/detail_policy.h"
#include "world/camera_frame.h"
#include "world/coat_motion.h"
#include "world/frame_characters.h"

namespace pelage {
namespace {

class FramePoser {
 public:
  FramePoser(const SceneDescription& scene, const Assets& assets, const CameraParams& camera, double frame,
             const Job& job)
      : scene_(scene),
        assets_(assets),
        frame_(frame),
        job_(job),
        camera_(camera, frame, scene.image.width, scene.image.height),
        lod_view_(lod_view()),
        detail_(scene.render.lod, lod_view_, scene.camera.shutter, job),
        poses_(std::make_shared<PoseCache>(job.workers.thread_count(), job.ledger)) {}

  void add(const FrameCharacter& character, bool reduced, FrameParts& parts) {
    for (size_t part = 0; part < character.params->parts.size(); ++part)
      add_part(character, part, reduced, parts);
  }

 private:
  LodView lod_view() const {
    const std::optional<CameraParams>& own = scene_.render.lod.camera.own;
    return own ? Camera(*own, frame_, scene_.image.width, scene_.image.height).lod_view()
               : camera_.lod_view();
  }

  void add_part(const FrameCharacter& character, size_t index, bool reduced, FrameParts& parts) {
    const PartParams& part = character.params->parts[index];
    const Assets::Skin& skin = assets_.skins.at(part.skin.name);
    CharacterPose pose = pose_character(character, index, assets_, scene_.camera, frame_);
    for (const auto& groom : part.grooms.items) {
      if (assets_.grooms.at(groom.name)->needs_closest_point()) pose.push_out_view = camera_.view();
    }
    const Rgb tint = character.member ? character.member->tint : Rgb(1);
    PosedCages cages = pose.shutter;
    const bool at_rest =
        std::all_of(cages.cages.begin(), cages.cages.end(),
                    [&](const std::vector<V3f>& cage) { return cage == skin.cage.positions; });
    const auto posed = std::make_shared<PosedCharacterSkin>(std::move(pose), poses_);
    parts.skins.push_back({character.name + "." + part.skin.name, part.skin.name, part.material.name, tint,
                           std::move(cages), at_rest, posed});
    for (const auto& groom : part.grooms.items) {
      FrameCoat coat{character.name, groom.name, groom.value.name, tint, assets_.grooms.at(groom.name),
                     posed,          skin.rest,  at_rest,          {},   {}};
      if (reduced) {
        coat.lod = detail_.simplification(*coat.coat, skin.rest.get(), *posed);
        coat.direction = detail_.direction(*coat.coat, skin.rest);
      }
      coat.coat = moved_coat(scene_, assets_, character, index, groom.name, frame_,
                             static_cast<size_t>(posed->motion_keys()), job_);
      posed->reserve_for_leaves(*coat.coat, reduced);
      parts.coats.push_back(std::move(coat));
    }
  }

  const SceneDescription& scene_;
  const Assets& assets_;
  const double frame_;
  const Job& job_;
  const Camera camera_;
  const LodView lod_view_;
  DetailPolicy detail_;
  std::shared_ptr<PoseCache> poses_;
};

/// A camera so far from `box` that everything in it has the same size.
LodView far_view(const Box3f& box, float pixels_per_unit) {
  const float distance = 1e3f * std::max(1e-6f, box.size().length());
  LodView view;
  view.open.position = box.center() + V3f(0, 0, distance);
  view.open.focal_pixels = pixels_per_unit * distance;
  view.close = view.open;
  return view;
}

}  // namespace

Simplification scale_detail(const FrameCoat& coat, SimplificationParams params, float pixels_per_unit,
                            const Workers& workers) {
  params.motion_blur = params.depth_of_field = params.back_facing = false;
  const Box3f box = coat.skin->bound(BoundSpan::kShutter);
  MemoryLedger ledger;
  NoProgress progress;
  const Job job{workers, ledger, progress};
  DetailPolicy policy(params, far_view(box, pixels_per_unit), V2f(0), job);
  return policy.simplification(*coat.coat, coat.rest.get(), *coat.skin);
}

FrameParts pose_frame(const SceneDescription& scene, const Assets& assets, double frame, const Job& job,
                      const std::set<std::string>& only) {
  const std::vector<FrameCharacter> characters = frame_characters(scene, assets);
  FrameParts parts;
  parts.camera = focused_camera(placed_camera(scene, assets, job), assets, characters, frame);
  FramePoser poser(scene, assets, parts.camera, frame, job);
  for (const FrameCharacter& character : characters) {
    job.check_stop();
    if (only.empty() || only.contains(character.name)) poser.add(character, scene.render.lod.enabled, parts);
  }
  return parts;
}

std::vector<float> motion_times(const CameraParams& camera, int keys) {
  std::vector<float> times(static_cast<size_t>(keys), camera.shutter.x);
  for (int key = 1; key < keys; ++key) {
    const float t = static_cast<float>(key) / static_cast<float>(keys - 1);
    times[static_cast<size_t>(key)] = camera.shutter.x + t * (camera.shutter.y - camera.shutter.x);
  }
  return times;
}

}  // namespace pelage
