// SPDX-License-Identifier: Apache-2.0
// Tested in tests/world/compose_test.cpp.
#include "world/assets.h"

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "geom/io/obj_file.h"
#include "render/fibre/fibre_material.h"
#include "world/crowds.h"
#include "world/drawn_characters.h"
#include "world/map_check.h"
#include "world/skin_room.h"

namespace pelage {

namespace {

using SharedTopologies = std::vector<std::shared_ptr<const SurfaceTopology>>;

// Cages of identical topology share one refiner and one set of patches.
std::shared_ptr<const SurfaceTopology> share(std::shared_ptr<const SurfaceTopology> topology,
                                             SharedTopologies& known) {
  for (const auto& other : known) {
    if (other->hash() == topology->hash()) return other;
  }
  known.push_back(topology);
  return topology;
}

// A missing file is an error at the place in the scene that names it.
void require_file(const std::filesystem::path& file, const SourcePosition& named_at) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw Error(ErrorKind::kInput, named_at, "no such file " + file.string());
  }
}

std::vector<std::filesystem::path> pose_files(const PosesParams& poses) {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < poses.count; ++i) {
    files.emplace_back(frame_file_name(poses.files.path.string(), poses.first + i));
    require_file(files.back(), poses.files.position);
  }
  return files;
}

PoseSequence pose_sequence(const PosesParams& params, const ControlMesh& cage, MemoryLedger& ledger) {
  return PoseSequence(pose_files(params), params.first, params.cycle, cage.positions.size(), ledger,
                      params.frames_per_pose);
}

Assets::Skin load_skin(const std::string& name, const SkinParams& params, SharedTopologies& topologies,
                       const Job& job) {
  require_file(params.mesh.path, params.mesh.position);
  MemoryCharge reading = reserve_reading(name, params, job);
  ControlMesh cage = read_obj(params.mesh.path, job);
  reading = {};
  const MemoryCharge making = reserve_skin(name, params, cage, job);
  const auto topology =
      share(SurfaceTopology::create(cage, params.scheme, params.boundary, params.mesh.path.string(), job),
            topologies);
  job.check_stop();
  auto rest = std::make_shared<LimitSurface>(topology, cage.positions);
  Assets::Skin skin{std::move(rest), std::move(cage), {}};
  if (params.poses) skin.poses.emplace(pose_sequence(*params.poses, skin.cage, job.ledger));
  return skin;
}

/// If the strands of the scene cannot fit the memory limit, fails before the first is placed.
void require_room_for_strands(const SceneDescription& scene, const Job& job) {
  int64_t kept = 0;
  for (const auto& [name, position, params] : scene.grooms.items) {
    if (!params.strands || params.cache) continue;
    require_room(job.ledger, kept + follicle_temporary_bytes(*params.strands),
                 fmt::format("placing {} strands of groom '{}'", *params.strands, name));
    kept += follicle_bytes(*params.strands);
  }
}

bool only_holes(const SurfaceTopology& topology) {
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (!topology.is_hole(face)) return false;
  }
  return true;
}

/// Makes a groom; errors without a position get the position of the groom.
std::shared_ptr<const Groom> make_groom(const std::string& name, const SourcePosition& position,
                                        const GroomParams& params,
                                        const std::shared_ptr<const LimitSurface>& rest,
                                        TextureLibrary& textures, const Job& job) {
  try {
    auto groom = Groom::create(name, params, rest, textures, job);
    if (rest && params.strands_file.empty() && only_holes(rest->topology())) {
      job.progress.warn(fmt::format("{}: groom '{}' grows nothing, because all faces of skin '{}' are holes",
                                    to_string(position), name, params.skin.name));
    }
    return groom;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.position.file.empty()) problem.position = position;
    }
    throw Error(error.kind(), std::move(problems));
  }
}

/// Memory of each character in a frame, by its index in the scene.
std::vector<int64_t> drawn_bytes(const SceneDescription& scene, const Assets& assets) {
  std::vector<int64_t> bytes;
  for (const auto& [name, position, params] : scene.characters.items)
    bytes.push_back(drawn_character_bytes(scene, assets, name, params));
  return bytes;
}

}  // namespace

std::unique_ptr<Assets> load_assets(const SceneDescription& scene, const Job& job) {
  MemoryLedger& ledger = job.ledger;
  ledger.set_limit(scene.render.memory.bytes);
  require_room_for_strands(scene, job);
  auto assets = std::make_unique<Assets>(ledger, &job.progress);
  SharedTopologies topologies;
  for (const auto& [name, position, params] : scene.skins.items) {
    job.check_stop();
    const Assets::Skin& skin =
        assets->skins.emplace(name, load_skin(name, params, topologies, job)).first->second;
    assets->charges.emplace_back(ledger, MemoryTag::kSkins,
                                 static_cast<int64_t>(skin.rest->bytes() + skin.cage.bytes()));
  }
  check_maps(scene, assets->skins);
  for (const auto& topology : topologies) {
    assets->charges.emplace_back(ledger, MemoryTag::kSkins, static_cast<int64_t>(topology->bytes()));
  }
  for (const auto& [name, position, params] : scene.characters.items) {
    for (size_t part = 0; part < params.parts.size(); ++part) {
      const auto& [skin, material, grooms, poses] = params.parts[part];
      if (!poses) continue;
      job.check_stop();
      const ControlMesh& cage = assets->skins.at(skin.name).cage;
      assets->part_poses.emplace(std::pair(name, part), pose_sequence(*poses, cage, ledger));
    }
  }
  assets->crowds = make_crowds(scene, drawn_bytes(scene, *assets), job);
  for (const auto& crowd : assets->crowds) {
    assets->charges.emplace_back(ledger, MemoryTag::kSkins,
                                 static_cast<int64_t>(crowd.capacity() * sizeof(CrowdMember)));
  }
  for (const auto& [name, position, params] : scene.grooms.items) {
    const auto skin = assets->skins.find(params.skin.name);
    const auto rest = skin == assets->skins.end() ? nullptr : skin->second.rest;
    assets->grooms[name] = make_groom(name, position, params, rest, assets->textures, job);
  }
  assets->materials = load_materials(scene, assets->textures, job);
  return assets;
}

std::vector<MaterialParams> load_materials(const SceneDescription& scene, TextureLibrary& textures,
                                           const Job& job) {
  std::vector<MaterialParams> materials;
  for (const auto& [name, position, params] : scene.materials.items) {
    job.check_stop();
    materials.push_back(with_tables(with_textures(params, textures), job));
  }
  return materials;
}

}  // namespace pelage
