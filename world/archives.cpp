// SPDX-License-Identifier: Apache-2.0
#include "world/archives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "geom/skin_memory.h"
#include "procedurals/skin/pose_cache.h"
#include "procedurals/skin/posed_character_skin.h"
#include "rib/scene/rib_reading.h"
#include "world/archive_coats.h"
#include "world/compose.h"
#include "world/frame_characters.h"
#include "world/skin_memory_check.h"

namespace pelage {
namespace {

/// The time between the first and the last motion key of what a file contains. With a closed shutter, keys
/// are needed for motion vectors alone: up to the next frame.
V2f motion_span(const SceneDescription& scene) {
  const V2f& shutter = scene.camera.shutter;
  return shutter.y > shutter.x ? shutter : V2f(shutter.x, shutter.x + 1);
}

/// The transform of an archive over its motion keys.
RibTransform placement_of(const SceneDescription& scene, const TransformParams& transform, double frame,
                          const V3f& origin) {
  const V2f shutter = motion_span(scene);
  if (!moves(transform)) return RibTransform(character_matrix(transform, frame, origin));
  std::vector<std::pair<double, M44f>> samples;
  const int keys = scene.camera.shutter.y > scene.camera.shutter.x ? scene.camera.motion_keys : 2;
  for (int key = 0; key < keys; ++key) {
    const double time = shutter.x + double(shutter.y - shutter.x) * key / (keys - 1);
    samples.emplace_back(time, character_matrix(transform, frame + time, origin));
  }
  return RibTransform(std::move(samples));
}

ContentHash key_of(const ArchiveParams& params, const RibTransform& placement, double frame,
                   const V2f& shutter) {
  ContentHasher hasher;
  hasher.add(params.rib.path.string()).add(frame).add(shutter.x).add(shutter.y);
  for (const auto& [time, matrix] : placement.samples()) {
    hasher.add(time);
    for (const auto& row : matrix.x) {
      for (const float x : row) hasher.add(x);
    }
  }
  return hasher.digest();
}

size_t bytes_of(const RibScene& rib) {
  size_t bytes = 0;
  for (const RibCoat& coat : rib.coats) {
    for (const auto& batch : coat.batches) bytes += batch->bytes();
    bytes += coat.deferred.size() * sizeof(RibDeferredBatch);
  }
  for (const RibSkin& skin : rib.skins)
    bytes += skin.cage.bytes() + skin.keys.size() * skin.cage.positions.size() * sizeof(V3f);
  return bytes;
}

size_t material_of(const SceneDescription& scene, const ArchiveParams& params, const RibScene& rib,
                   size_t own) {
  const RibMaterial& material = rib.materials[own];
  const auto* entry = rib.frame ? params.materials.find(frame_material(material.name, *rib.frame)) : nullptr;
  if (!entry) entry = params.materials.find(material.name);
  if (!entry && rib.shadow_pass)
    throw Error(ErrorKind::kInput, params.rib.position,
                fmt::format("frame {} only draws shadow maps; choose another frame", rib.frame.value_or(0)));
  if (!entry)
    throw Error(ErrorKind::kInput, params.rib.position,
                "surface " + quote(material.name) + " has no material; add it to the table `materials`");
  size_t index = 0;
  while (scene.materials.items[index].name != entry->value.name)
    ++index;  // load_scene checked that it exists
  if ((fibre_params(scene.materials.items[index].value) != nullptr) != material.fibre)
    throw Error(ErrorKind::kInput, entry->value.position,
                quote(entry->value.name) + " is a material for " +
                    (material.fibre ? "skins, but the surface is on curves"
                                    : "strands, but the surface is on a mesh"));
  return index;
}

/// `strands`: number of strands before level of detail.
void add_fur(FurPart fur, int64_t strands, World& world) {
  Box3f box;
  for (const auto& procedural : fur.procedurals) box.extendBy(procedural->bound(BoundSpan::kShutter));
  ++world.counts.characters;
  if (world.scene.camera.may_see(box)) ++world.counts.characters_in_frame;
  world.counts.strands_described += strands;
  world.counts.strands_unique += strands;
  world.scene.fur.push_back(std::move(fur));
}

int64_t strand_count(const ArchiveCoat& coat) {
  const auto leaves = coat.coat.coat->follicles().leaves();
  const LeafRange range = coat.leaves.value_or(LeafRange{0, leaves.size()});
  int64_t count = 0;
  for (size_t leaf = range.first; leaf < range.end; ++leaf)
    count += static_cast<int64_t>(leaves[leaf].end - leaves[leaf].begin);
  return count;
}

void add_procedurals(const SceneDescription& scene, const std::string& name, const ArchiveParams& params,
                     const Archive& archive, const Job& job, World& world) {
  const RibShutter shutter{motion_span(scene)};
  std::set<const PosedCharacterSkin*> charged;
  for (const ArchiveCoat& coat : archive.procedurals->coats) {
    const RibOwnProcedural& request = archive.rib->own_procedurals[coat.procedural];
    if (charged.insert(coat.coat.skin.get()).second)
      world.charges.emplace_back(job.ledger, MemoryTag::kSkins,
                                 static_cast<int64_t>(coat.coat.skin->bytes()));
    FurPart fur = archive_fur(name + "." + coat.coat.character + "." + coat.coat.groom, coat, request,
                              material_of(scene, params, *archive.rib, request.material), shutter);
    // The skin below the coat is a mesh of the file. It has the level of detail of its densest coat.
    for (SkinPart& skin : world.scene.skins) {
      if (fur.lod && skin.name == name + "." + coat.skin &&
          (!skin.lod || fur.lod->depth() > skin.lod->depth()))
        skin.lod = fur.lod;
    }
    add_fur(std::move(fur), strand_count(coat), world);
  }
}

CharacterPose pose_of(const RibSkin& skin, const LimitSurface& rest) {
  CharacterPose pose;
  pose.topology = rest.shared_topology();
  for (const auto& key : skin.keys) {
    pose.shutter.cages.push_back(key);
    pose.shutter.transforms.emplace_back();
  }
  if (skin.keys.size() > 1) {
    // The file says nothing about the time outside of the shutter.
    for (const auto* key : {&skin.keys.front(), &skin.keys.back()}) {
      pose.frame_ends.cages.push_back(*key);
      pose.frame_ends.transforms.emplace_back();
    }
  }
  return pose;
}

}  // namespace

void load_archive(const SceneDescription& scene, const std::string& name, const ArchiveParams& params,
                  double frame, const Job& job, const V3f& origin, Archive& archive) {
  const RibTransform placement = placement_of(scene, params.transform, frame, origin);
  const ContentHash key = key_of(params, placement, frame, motion_span(scene));
  if (archive.rib && archive.key == key) return;
  const auto earlier = archive.procedurals;  // its scenes are used again
  archive = {};
  const std::string what = fmt::format("reading archive '{}'", name);
  RibReadOptions options;
  options.frame = static_cast<int>(std::lround(frame));
  options.shutter = motion_span(scene);
  options.placement = placement;
  options.mirror_left_handed = scene.from_rib;
  options.programs = scene.programs;
  options.max_request_bytes = std::numeric_limits<size_t>::max();  // `reserve` knows the limit
  options.reserve = [&](size_t bytes) { require_memory(job.ledger, static_cast<int64_t>(bytes), what); };
  options.check_stop = [&] { job.check_stop(); };
  auto rib = std::make_shared<RibScene>(read_rib(params.rib.path, options));
  // The others are known since the scene was loaded.
  for (const Problem& warning : rib->warnings) {
    if (warning.message.starts_with("dropped strands without extent"))
      job.progress.warn(to_string(warning.position) + ": " + warning.message);
  }
  size_t bytes = bytes_of(*rib);
  for (RibSkin& skin : rib->skins) {
    warn_of_equal_faces(merge_equal_faces(skin.cage), to_string(skin.position), "the mesh", job);
    const SkinMemory memory = skin_memory(skin.cage, skin.scheme);
    require_memory(job.ledger, static_cast<int64_t>(bytes + std::max(memory.making, memory.held)), what);
    const auto topology =
        SurfaceTopology::create(skin.cage, skin.scheme, skin.boundary, to_string(skin.position), job);
    archive.surfaces.push_back(std::make_shared<const LimitSurface>(topology, skin.cage.positions));
    bytes += topology->bytes() + archive.surfaces.back()->bytes();
    require_memory(job.ledger, static_cast<int64_t>(bytes), what);
  }
  archive.charge = MemoryCharge(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(bytes));
  if (!rib->own_procedurals.empty())
    archive.procedurals = std::make_shared<const ArchiveProcedurals>(
        pose_procedurals(*rib, scene, job, earlier ? earlier->scenes : ArchiveScenes()));
  archive.rib = std::move(rib);
  archive.key = key;
}

void add_archive(const SceneDescription& scene, const std::string& name, const ArchiveParams& params,
                 const Archive& archive, const Job& job, World& world) {
  const RibScene& rib = *archive.rib;
  const auto poses = std::make_shared<PoseCache>(job.workers.thread_count(), job.ledger);
  for (size_t i = 0; i < rib.skins.size(); ++i) {
    const RibSkin& skin = rib.skins[i];
    const size_t material = material_of(scene, params, rib, skin.material);
    const auto& rest = archive.surfaces[i];
    const auto posed = std::make_shared<PosedCharacterSkin>(pose_of(skin, *rest), poses);
    world.charges.emplace_back(job.ledger, MemoryTag::kSkins, static_cast<int64_t>(posed->bytes()));
    world.scene.skins.push_back({name + "." + skin.name, posed, rest, material, skin.tint});
  }
  for (const RibCoat& coat : rib.coats) {
    if (coat.batches.empty() && coat.deferred.empty()) continue;
    FurPart fur{
        name + "." + coat.name, {}, material_of(scene, params, rib, coat.material), nullptr, coat.tint};
    fur.procedurals.push_back(rib_procedural(coat));
    const auto strands = static_cast<int64_t>(fur.procedurals.back()->counts().strands);
    add_fur(std::move(fur), strands, world);
  }
  if (archive.procedurals) add_procedurals(scene, name, params, archive, job, world);
}

}  // namespace pelage
