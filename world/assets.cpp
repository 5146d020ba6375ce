// SPDX-License-Identifier: Apache-2.0
#include "world/assets.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/file_stamp.h"
#include "base/hash.h"
#include "base/job.h"
#include "base/memory_budget.h"
#include "base/nearest_name.h"
#include "geom/io/host_geometry.h"
#include "geom/io/mesh_file.h"
#include "geom/usd/usd_files.h"
#include "groom/strands/skin_fields.h"
#include "render/fibre/fibre_material.h"
#include "world/asset_files.h"
#include "world/frame_characters.h"
#include "world/map_check.h"
#include "world/scene_crowds.h"
#include "world/scene_origin.h"
#include "world/scene_schema.h"
#include "world/skin_memory_check.h"

namespace pelage {
namespace {

// Hashes of everything from which an asset is made: its part of the scene, and the stamps of its files. Equal
// keys mean equal assets within one process. Take a key before the files are read: if a file changes
// meanwhile, the next key is different.

void add_part(const SceneDescription& scene, const std::string& path, ContentHasher& hasher) {
  const auto part = scene.parts.find(path);
  hasher.add(path).add(part == scene.parts.end() ? ContentHash() : part->second);
}

void add_files(const std::vector<std::filesystem::path>& files, ContentHasher& hasher) {
  for (const std::filesystem::path& file : with_usd_files(files)) {
    const FileStamp stamp = file_stamp(file);
    hasher.add(file.string()).add(stamp.inode).add(stamp.size).add(stamp.changed_ns);
  }
}

ContentHash skin_key(const SceneDescription& scene, const std::string& name, const SkinParams& params) {
  ContentHasher hasher;
  add_part(scene, "skins." + name, hasher);
  if (!params.mesh.empty() && !params.mesh.data) add_files({params.mesh.path}, hasher);
  if (params.poses) add_files(pose_files(*params.poses), hasher);
  hasher.add(params.transform.meters_per_unit);
  return hasher.digest();
}

/// `skin`: the key of the skin on which the groom grows; anything for a groom without a skin.
ContentHash groom_key(const SceneDescription& scene, const std::string& name, const GroomParams& params,
                      const ContentHash& skin) {
  ContentHasher hasher;
  add_part(scene, "grooms." + name, hasher);
  std::vector<std::filesystem::path> files;
  add_groom_files(params, files);
  add_files(files, hasher);
  if (params.transform) hasher.add(params.transform->meters_per_unit);
  return hasher.add(skin).add(params.leaf_size()).digest();  // its size may depend on the memory limit
}

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

// A missing file is an error at the place in the scene that names it. So is a cycle of links.
void require_file(const std::filesystem::path& file, const SourcePosition& named_at) {
  std::error_code error;
  const bool exists = std::filesystem::exists(file, error);
  if (error) throw Error(ErrorKind::kInput, named_at, file.string() + ": cannot read: " + error.message());
  if (!exists) throw Error(ErrorKind::kInput, named_at, "no such file " + file.string());
}

PoseSequence pose_sequence(const PosesParams& params, const MeshOrder& order, const M44f& to_scene,
                           MemoryLedger& ledger) {
  if (params.files.data) {
    return PoseSequence(host_poses(params.files, static_cast<size_t>(params.count), order.vertices),
                        params.first, params.cycle, order, ledger, params.frames_per_pose, to_scene);
  }
  const std::vector<std::filesystem::path> files = pose_files(params);
  for (const std::filesystem::path& file : files) require_file(file, params.files.position);
  return PoseSequence(files, params.first, params.cycle, order, ledger, params.frames_per_pose, to_scene);
}

/// A cage whose only face is a hole.
ControlMesh no_surface() {
  ControlMesh cage;
  cage.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  cage.face_sizes = {3};
  cage.face_vertices = {0, 1, 2};
  cage.holes = {0};
  return cage;
}

Assets::Skin load_skin(const std::string& name, const SkinParams& params, SharedTopologies& topologies,
                       const Job& job) {
  const bool from_file = !params.mesh.empty() && !params.mesh.data;
  if (from_file) require_file(params.mesh.path, params.mesh.position);
  // Only the memory of an OBJ follows from the size of its file: a USD file may refer to other files, and an
  // Alembic file may contain more than meshes. The readers of these formats charge their memory themselves.
  const bool known_size = from_file && !is_usd_file(params.mesh.path) && !is_alembic_file(params.mesh.path);
  MemoryCharge reading = known_size ? reserve_reading(name, params, job) : MemoryCharge();
  ControlMesh cage = from_file          ? read_mesh_file(params.mesh.path, job)
                     : params.mesh.data ? host_mesh(params.mesh)
                                        : no_surface();
  const MeshOrder order = mesh_order(cage);
  warn_of_equal_faces(merge_equal_faces(cage), to_string(params.mesh.position), params.mesh.path.string(),
                      job);
  const M44f to_scene = params.transform.matrix();
  transform_cage(to_scene, cage);
  reading = {};
  const MemoryCharge making = reserve_skin(name, params, cage, job);
  const auto topology =
      share(SurfaceTopology::create(cage, params.scheme, params.boundary, params.mesh.path.string(), job),
            topologies);
  job.check_stop();
  auto rest = std::make_shared<LimitSurface>(topology, cage.positions);
  Assets::Skin skin{std::move(rest), std::move(cage), order, {}, {}, {}};
  if (params.poses) skin.poses.emplace(pose_sequence(*params.poses, order, to_scene, job.ledger));
  return skin;
}

/// If the strands of the scene cannot fit the memory limit, fails before the first is placed.
void require_memory_for_strands(const SceneDescription& scene, const Assets& assets, const Job& job) {
  int64_t kept = 0;
  for (const auto& [name, position, params] : scene.grooms.items) {
    if (!params.strands || params.cache || assets.groom_keys.contains(name)) continue;
    require_memory(job.ledger, kept + follicle_temporary_bytes(*params.strands),
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
                                        const FieldSources& sources, const Job& job, const Groom* previous,
                                        const SceneDescription& scene) {
  try {
    auto groom = Groom::create(name, params, rest, sources, job, previous, scene.growth_cache.get(),
                               scene.scripts.get());
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

/// "skins.NAME" and "grooms.NAME" to keys.
std::map<std::string, ContentHash> asset_keys(const SceneDescription& scene) {
  std::map<std::string, ContentHash> keys;
  for (const auto& [name, position, params] : scene.skins.items)
    keys["skins." + name] = skin_key(scene, name, params);
  for (const auto& [name, position, params] : scene.grooms.items)
    keys["grooms." + name] = groom_key(scene, name, params, keys["skins." + params.skin.name]);
  return keys;
}

/// Frees everything that changes, before anything new needs memory. Grooms that change stay without a key
/// until their follicles were compared. Returns the new keys.
std::map<std::string, ContentHash> drop_old(const SceneDescription& scene, Assets& assets) {
  const std::map<std::string, ContentHash> keys = asset_keys(scene);
  std::erase_if(assets.skins, [&](const auto& skin) {
    const auto key = keys.find("skins." + skin.first);
    return key == keys.end() || key->second != skin.second.key;
  });
  std::erase_if(assets.groom_keys, [&](const auto& groom) {
    const auto key = keys.find("grooms." + groom.first);
    return key == keys.end() || key->second != groom.second;
  });
  std::erase_if(assets.grooms, [&](const auto& groom) { return !keys.contains("grooms." + groom.first); });
  assets.textures.forget_changed();
  return keys;
}

void update_skins(const SceneDescription& scene, const std::map<std::string, ContentHash>& keys,
                  const Job& job, Assets& assets) {
  SharedTopologies topologies;
  // What is made is charged before the next skin is checked against the limit.
  auto charge_new = [&, charged = size_t(0)]() mutable {
    for (; charged < topologies.size(); ++charged)
      assets.charges.emplace_back(job.ledger, MemoryTag::kSkins,
                                  static_cast<int64_t>(topologies[charged]->bytes()));
  };
  for (const auto& [name, skin] : assets.skins) share(skin.rest->shared_topology(), topologies);
  charge_new();
  for (const auto& [name, position, params] : scene.skins.items) {
    if (assets.skins.contains(name)) continue;
    job.check_stop();
    Assets::Skin skin = load_skin(name, params, topologies, job);
    skin.key = keys.at("skins." + name);
    skin.charge = MemoryCharge(job.ledger, MemoryTag::kSkins,
                               static_cast<int64_t>(skin.rest->bytes() + skin.cage.bytes()));
    assets.skins.emplace(name, std::move(skin));
    charge_new();
  }
}

/// What fields read from a skin; nothing if there is no such skin.
std::optional<SkinFields> skin_fields(const Assets& assets, const std::string& name, const Job& job) {
  const auto skin = assets.skins.find(name);
  if (skin == assets.skins.end()) return {};
  return std::optional<SkinFields>(std::in_place, "skin " + quote(name), *skin->second.rest,
                                   skin->second.cage, job);
}

/// The skin on which a material is used, itself or for strands; "" if there is more than one. Any skin if
/// nothing uses the material.
std::string skin_of_material(const SceneDescription& scene, const Assets& assets,
                             const std::string& material) {
  std::set<std::string> skins;
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      if (part.material.name == material) skins.insert(part.skin.name);
      for (const auto& groom : part.grooms.items) {
        if (groom.value.name != material) continue;
        const auto* grown = scene.grooms.find(groom.name);
        skins.insert(grown ? grown->value.skin.name : "");
      }
    }
  }
  for (const auto& archive : scene.archives.items) {
    for (const auto& surface : archive.value.materials.items) {
      if (surface.value.name == material) skins.insert("");
    }
  }
  if (skins.empty() && !assets.skins.empty()) return assets.skins.begin()->first;
  return skins.size() == 1 ? *skins.begin() : "";
}

void update_grooms(const SceneDescription& scene, const std::map<std::string, ContentHash>& keys,
                   const Job& job, Assets& assets) {
  for (const auto& [name, position, params] : scene.grooms.items) {
    if (assets.groom_keys.contains(name)) continue;
    const auto skin = assets.skins.find(params.skin.name);
    const auto rest = skin == assets.skins.end() ? nullptr : skin->second.rest;
    const std::optional<SkinFields> fields = skin_fields(assets, params.skin.name, job);
    std::shared_ptr<const Groom>& groom = assets.grooms[name];
    groom = make_groom(name, position, params, rest, {assets.textures, fields ? &*fields : nullptr}, job,
                       groom.get(), scene);
    assets.groom_keys[name] = keys.at("grooms." + name);
  }
}

}  // namespace

std::unique_ptr<Assets> load_assets(const SceneDescription& scene, const Job& job) {
  auto assets = std::make_unique<Assets>(job.ledger, &job.progress);
  update_assets(scene, job, *assets);
  return assets;
}

void update_assets(const SceneDescription& scene, const Job& job, Assets& assets) {
  job.ledger.set_limit(scene.render.memory.bytes);
  assets.charges.clear();
  assets.crowds.clear();
  assets.archives.clear();
  assets.part_poses.clear();
  assets.materials.clear();
  const std::map<std::string, ContentHash> keys = drop_old(scene, assets);
  require_memory_for_strands(scene, assets, job);
  update_skins(scene, keys, job, assets);
  check_maps(scene, assets.skins, job.progress);
  for (const auto& [name, position, params] : scene.characters.items) {
    for (size_t part = 0; part < params.parts.size(); ++part) {
      const auto& [skin, material, grooms, poses] = params.parts[part];
      if (!poses) continue;
      job.check_stop();
      const MeshOrder& order = assets.skins.at(skin.name).order;
      const M44f to_scene = scene.skins.find(skin.name)->value.transform.matrix();
      assets.part_poses.emplace(std::pair(name, part), pose_sequence(*poses, order, to_scene, job.ledger));
    }
  }
  assets.crowds = place_crowds(scene, assets, job);
  for (const auto& crowd : assets.crowds) {
    assets.charges.emplace_back(job.ledger, MemoryTag::kSkins,
                                static_cast<int64_t>(crowd.capacity() * sizeof(CrowdMember)));
  }
  update_grooms(scene, keys, job, assets);
  assets.materials = load_materials(scene, assets, job);
  if (const auto coarse = coarse_position(scene, assets, scene.frames.frames.front()))
    job.progress.warn(*coarse);
}

namespace {

/// Everything that the document states about the fibres of a material, without their colour and opacity.
/// Empty if the scene has no document.
std::string fibre_text(const SceneParts& parts, const std::string& material) {
  const std::string prefix = "materials." + material + ".";
  std::string text;
  for (auto part = parts.lower_bound(prefix); part != parts.end() && part->first.starts_with(prefix);
       ++part) {
    const std::string key = part->first.substr(prefix.size());
    const bool other = key.find('.') != std::string::npos;  // a material whose name begins with this name
    if (other || key == "color" || key == "color_attribute" || key == "opacity") continue;
    text += fmt::format("{} {:x} {:x}\n", key, part->second.high, part->second.low);
  }
  return text;
}

}  // namespace

std::vector<MaterialParams> load_materials(const SceneDescription& scene, Assets& assets, const Job& job) {
  std::vector<MaterialParams> materials;
  std::map<std::string, const FibreParams*> made;  // a table is made once for all materials that share it
  materials.reserve(scene.materials.items.size());
  for (const auto& [name, position, params] : scene.materials.items) {
    job.check_stop();
    const std::optional<SkinFields> fields = skin_fields(assets, skin_of_material(scene, assets, name), job);
    MaterialParams material = with_textures(params, {assets.textures, fields ? &*fields : nullptr});
    const std::string text = fibre_text(scene.parts, name);
    if (const auto known = made.find(text); known != made.end() && fibre_params(material)) {
      std::visit(
          [&]<class P>(P& p) {
            if constexpr (std::is_base_of_v<FibreParams, P>) p.coat_color = known->second->coat_color;
          },
          material);
    }
    materials.push_back(with_tables(std::move(material), job));
    if (const FibreParams* fibre = fibre_params(materials.back()); fibre && !text.empty())
      made.try_emplace(text, fibre);
  }
  return materials;
}

}  // namespace pelage
