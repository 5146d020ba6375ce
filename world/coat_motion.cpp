// SPDX-License-Identifier: Apache-2.0
#include "world/coat_motion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/file.h"
#include "base/memory_budget.h"
#include "base/program.h"
#include "base/program_identity.h"
#include "groom/operators/follow.h"
#include "world/asset_files.h"
#include "world/file_motion.h"
#include "world/sway.h"

namespace pelage {
namespace {

template <class T>
std::string text_of(const Keyed<T>& values) {
  std::string text;
  for (const auto& [frame, value] : values.keys())
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", frame, ValueReader<T>::print(value));
  return text;
}

/// Blocks of a scene that do not change motion, and what a command states by itself.
constexpr std::string_view kPictureKeys[] = {"frames", "image", "render", "lights", "magnets", "materials"};

using Inputs = std::vector<std::pair<std::string, std::string>>;

void add_character(const FrameCharacter& character, const std::string& prefix, Inputs& inputs) {
  const CharacterParams& params = *character.params;
  inputs.emplace_back(prefix + "translate", text_of(params.transform.translate));
  inputs.emplace_back(prefix + "rotate", text_of(params.transform.rotate));
  inputs.emplace_back(prefix + "scale", text_of(params.transform.scale));
  inputs.emplace_back(prefix + "frame_offset", fmt::format("{}", params.frame_offset));
}

void add_poses(const SceneDescription& scene, const PartParams& part, const std::string& prefix,
               Inputs& inputs) {
  const auto* skin = scene.skins.find(part.skin.name);
  const std::optional<PosesParams>& own = part.poses ? part.poses : skin->value.poses;
  if (!own) return;
  ContentHasher files;
  for (const std::filesystem::path& file : pose_files(*own)) files.add(file_hash(file));
  const M44f to_scene = skin->value.transform.matrix();
  files.add(std::span<const float>(&to_scene[0][0], 16));
  inputs.emplace_back(prefix + "poses", fmt::format("{} {} {} {}", own->first, own->count,
                                                    own->frames_per_pose, own->cycle ? "cycle" : "once"));
  inputs.emplace_back(prefix + "contents of poses", to_string(files.digest()));
}

Inputs inputs_of(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat) {
  Inputs inputs{{"version", std::to_string(MotionStore::kVersion)},
                {"machine", arithmetic_identity()},
                {"coat", to_string(coat.groom->identity())},
                {"meters_per_unit", fmt::format("{}", scene.units.meters_per_unit)},
                {"fps", fmt::format("{}", scene.units.fps)},
                {"first frame", std::to_string(coat.start)}};
  for (const ParameterText& parameter : DynamicsParams::schema().describe(*coat.params)) {
    const bool elsewhere =
        parameter.key == "files" || parameter.key == "directory" || parameter.key == "start" ||
        parameter.key == "preroll" || parameter.key.starts_with("wind.velocity") ||
        parameter.key.starts_with("wind.gusts") || parameter.key.starts_with("wind.turbulence");
    if (!elsewhere) inputs.emplace_back(parameter.key, parameter.text);
  }
  // Keyed values print as their value at one frame.
  inputs.emplace_back("wind.velocity", text_of(coat.params->wind.velocity));
  inputs.emplace_back("wind.gusts", text_of(coat.params->wind.gusts));
  inputs.emplace_back("wind.turbulence", text_of(coat.params->wind.turbulence));
  add_character(coat.character, "", inputs);
  add_poses(scene, coat.character.params->parts[coat.part], "", inputs);
  for (const auto& [character, part] : coat.colliders) {
    const std::string prefix = fmt::format("{}.{} ", character.name, part);
    const std::string& skin = character.params->parts[part].skin.name;
    inputs.emplace_back(prefix + "skin", to_string(assets.skins.at(skin).rest->hash()));
    add_character(character, prefix, inputs);
    add_poses(scene, character.params->parts[part], prefix, inputs);
  }
  return inputs;
}

ContentHash motion_key(const std::string& coat, const Inputs& inputs) {
  ContentHasher hasher;
  hasher.add(coat);
  for (const auto& [name, value] : inputs) hasher.add(name).add(value);
  return hasher.digest();
}

/// The command that makes the motion of a frame. Repeats the settings that can change motion.
std::string simulate_line(const SceneDescription& scene, double frame) {
  std::vector<std::string> command{"pelage", "simulate",
                                   scene.files.empty() ? "SCENE" : scene.files.front().string()};
  for (const std::string& setting : scene.settings) {
    const bool is_of_picture =
        std::any_of(std::begin(kPictureKeys), std::end(kPictureKeys), [&](std::string_view key) {
          return setting.starts_with(key) && (setting[key.size()] == '.' || setting[key.size()] == '=');
        });
    if (!is_of_picture) command.insert(command.end(), {"--set", setting});
  }
  if (scene.scripts) command.emplace_back("--allow-scripts");
  const std::vector<int>& all = scene.frames.frames;
  const bool is_of_scene = std::find(all.begin(), all.end(), frame) != all.end();
  command.insert(command.end(),
                 {"--frames", is_of_scene ? print_frames(scene.frames) : fmt::format("{}", frame)});
  return shell_line(command);
}

/// A folder of its own, because `pelage grow --prune` empties the folder of coats.
ContentStore motion_folder(const DynamicsParams& dynamics) {
  return ContentStore(dynamics.directory.path / "motion");
}

constexpr const char* kInputsKind = "motion-inputs";

ContentHash inputs_key(const MovingCoat& coat) { return ContentHasher().add(coat.name).digest(); }

/// The turns of a coat at the ends of half frames. The half frame with the number h ends at frame h / 2.
class HalfFrames {
 public:
  HalfFrames(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat, double frame,
             const Job& job)
      : scene_(scene), coat_(coat), frame_(frame), job_(job) {
    if (coat.params->mode == DynamicsMode::kKinematic)
      sway_.emplace(scene, assets, coat.character, coat.part, *coat.groom, *coat.params);
    if (!coat.params->files.empty()) files_.emplace(scene, assets, coat, frame, job);
  }

  GuideTurns at(double time) {
    const double half = std::floor(2 * time);
    const auto t = static_cast<float>(2 * time - half);
    GuideTurns turns = read(static_cast<int>(half));
    if (t == 0) return turns;
    return blend_turns(std::move(turns), read(static_cast<int>(half) + 1), t);
  }

 private:
  const GuideTurns& read(int half) {
    const auto known = known_.find(half);
    if (known != known_.end()) return known->second;
    if (sway_) return known_[half] = sway_->at(half);
    if (files_) return known_[half] = files_->at(half);
    if (half <= 2 * coat_.start) {
      GuideTurns still;
      for (size_t i = 0; i < coat_.segments(); ++i) still.insert(still.end(), {0, 0, 0, 1});
      return known_[half] = std::move(still);
    }
    const int frame = half >= 0 ? (half + 1) / 2 : -(-half / 2);
    const auto warn = [&](const std::string& line) { job_.progress.warn(line); };
    std::optional<FrameMotionData> motion = coat_.store.read(frame, coat_.segments(), false, warn);
    if (!motion) {
      throw Error(ErrorKind::kInput, fmt::format("coat '{}' has no simulated motion for frame {}; run: {}",
                                                 coat_.name, frame_, simulate_line(scene_, frame_)));
    }
    known_[2 * frame - 1] = std::move(motion->half);
    known_[2 * frame] = std::move(motion->whole);
    return known_[half];
  }

  const SceneDescription& scene_;
  const MovingCoat& coat_;
  double frame_;
  const Job& job_;
  std::optional<Sway> sway_;         // only for `mode: kinematic`
  std::optional<FileMotion> files_;  // only with `files`
  std::map<int, GuideTurns> known_;
};

}  // namespace

size_t MovingCoat::segments() const {
  return groom->guides()->follicles.size() * static_cast<size_t>(groom->points() - 1);
}

std::optional<MovingCoat> moving_coat(const SceneDescription& scene, const Assets& assets,
                                      const FrameCharacter& character, size_t part,
                                      const std::string& groom) {
  const auto& params = scene.grooms.find(groom)->value;
  if (!params.dynamics) return {};
  const DynamicsParams& dynamics = *params.dynamics;
  MovingCoat coat{character.name + "." + groom,      character, part,
                  assets.grooms.at(groom),           &dynamics, {},
                  dynamics.start - dynamics.preroll, {},        MotionStore(motion_folder(dynamics), {})};
  if (!dynamics.is_simulated()) return coat;
  for (const NameReference& name : dynamics.collide_with) {
    const FrameCharacter other{name.name, name.name, &scene.characters.find(name.name)->value, {}};
    for (size_t other_part = 0; other_part < other.params->parts.size(); ++other_part) {
      const bool is_own = other.name == character.name && other_part == part;
      if (!is_own && other.params->parts[other_part].skin.name != kNoSkin)
        coat.colliders.emplace_back(other, other_part);
    }
  }
  coat.inputs = inputs_of(scene, assets, coat);
  coat.store = MotionStore(motion_folder(dynamics), motion_key(coat.name, coat.inputs));
  return coat;
}

std::vector<MovingCoat> moving_coats(const SceneDescription& scene, const Assets& assets) {
  std::vector<MovingCoat> coats;
  for (const FrameCharacter& character : frame_characters(scene, assets)) {
    if (character.member) continue;
    for (size_t part = 0; part < character.params->parts.size(); ++part) {
      for (const auto& groom : character.params->parts[part].grooms.items) {
        auto coat = moving_coat(scene, assets, character, part, groom.name);
        if (coat) coats.push_back(std::move(*coat));
      }
    }
  }
  return coats;
}

bool has_simulated_coat(const SceneDescription& scene) {
  for (const auto& character : scene.characters.items) {
    for (const PartParams& part : character.value.parts) {
      for (const auto& groom : part.grooms.items) {
        const auto* coat = scene.grooms.find(groom.name);
        if (coat && coat->value.dynamics && coat->value.dynamics->is_simulated()) return true;
      }
    }
  }
  return false;
}

std::filesystem::path manifest_file(const MovingCoat& coat) {
  return coat.store.store().file(kInputsKind, inputs_key(coat));
}

void store_inputs(const MovingCoat& coat) {
  ContentStore::Writer writer = coat.store.store().writer(kInputsKind, inputs_key(coat));
  for (const auto& [name, value] : coat.inputs) {
    writer.add(std::span<const char>(name));
    writer.add(std::span<const char>(value));
  }
  writer.commit([](const std::string&) {});
}

std::vector<MotionChange> changed_inputs(const MovingCoat& coat) {
  const auto file = coat.store.store().open(kInputsKind, inputs_key(coat), [](const std::string&) {});
  if (!file) return {};
  const auto text = [&](size_t section) {
    const std::span<const std::byte> bytes = file->section(section);
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  std::vector<MotionChange> changes;
  for (const auto& [name, value] : coat.inputs) {
    for (size_t i = 0; i + 1 < file->section_count(); i += 2) {
      if (text(i) == name && text(i + 1) != value) changes.push_back({name, text(i + 1)});
    }
  }
  return changes;
}

std::pair<int, int> frames_of_motion(const CameraParams& camera, double frame) {
  const double open = frame + std::min(-0.5, double(camera.shutter.x));
  const double close = frame + std::max(0.5, double(camera.shutter.y));
  const auto holder = [](double half) { return static_cast<int>(std::ceil(half / 2)); };
  return {holder(std::floor(2 * open)), holder(std::ceil(2 * close))};
}

GuideTurns guide_turns(const SceneDescription& scene, const Assets& assets, const MovingCoat& coat,
                       double frame, const Job& job) {
  return HalfFrames(scene, assets, coat, frame, job).at(frame);
}

std::shared_ptr<const Groom> moved_coat(const SceneDescription& scene, const Assets& assets,
                                        const FrameCharacter& character, size_t part,
                                        const std::string& groom, double frame, size_t keys, const Job& job) {
  const auto& still = assets.grooms.at(groom);
  if (!still->guides()) return still;
  const std::optional<MovingCoat> coat = moving_coat(scene, assets, character, part, groom);
  auto motion = std::make_shared<CoatMotion>();
  motion->charge = reserve(job.ledger, MemoryTag::kGrooms,
                           static_cast<int64_t>((keys + 6) * coat->segments() * 4 * sizeof(float)),
                           "the motion of " + coat->name);
  HalfFrames half_frames(scene, assets, *coat, frame, job);
  const V2f shutter = scene.camera.shutter;
  motion->keys.push_back(half_frames.at(frame - 0.5));
  for (size_t key = 0; key < keys; ++key) {
    const double t = keys > 1 ? static_cast<double>(key) / static_cast<double>(keys - 1) : 0;
    motion->keys.push_back(half_frames.at(frame + shutter.x + t * (double(shutter.y) - shutter.x)));
  }
  motion->keys.push_back(half_frames.at(frame + 0.5));
  ContentHasher hasher;
  for (const GuideTurns& turns : motion->keys) hasher.add(std::span<const float>(turns));
  motion->hash = hasher.digest();
  return still->moved(std::move(motion));
}

}  // namespace pelage
