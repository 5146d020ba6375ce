// SPDX-License-Identifier: Apache-2.0
#include "rib/host/scene_rib.h"

#include <map>

#include <fmt/format.h>

#include "base/file_name.h"
#include "base/version.h"
#include "groom/strands/skin_fields.h"
#include "rib/host/camera_rib.h"
#include "rib/host/shading_rib.h"
#include "rib/host/skin_rib.h"
#include "scene/yaml_text.h"
#include "world/frame_coats.h"
#include "world/frames.h"
#include "world/regions.h"

namespace pelage {
namespace {

Value document_of(const SceneRibSource& source) {
  Problems problems;
  RenamedKeys renamed{SceneDescription::schema()};
  std::optional<Value> document = load_document(source.path, source.overrides, problems, &renamed);
  if (document) expand_regions(*document, problems);
  problems.throw_if_any();
  if (!document) throw Error(ErrorKind::kInput, source.path.string() + ": changed while it was read");
  make_paths_absolute(*document, SceneDescription::schema());
  return std::move(*document);
}

/// The name of a RIB file without its ending.
std::string stem_of(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  for (const std::string_view ending : {".gz", ".rib"}) {
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  }
  return name;
}

std::string absolute_text(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

/// A box around everything in a frame.
Box3f content_of(const FrameParts& parts) {
  Box3f box;
  for (const FrameSkin& skin : parts.skins) box.extendBy(skin.posed->bound(BoundSpan::kFrame));
  for (const FrameCoat& coat : parts.coats) {
    const V3f reach(coat.coat->reach() * coat.skin->scale() * std::max(1.0f, coat.skin->length()));
    const Box3f skin = coat.skin->bound(BoundSpan::kFrame);
    if (skin.isEmpty()) continue;
    box.extendBy(skin.min - reach);
    box.extendBy(skin.max + reach);
  }
  return box;
}

class SceneRibWriter {
 public:
  SceneRibWriter(const std::filesystem::path& output, const SceneRibSource& source,
                 const SceneRibOptions& options, const Job& job)
      : output_(output),
        source_(source),
        options_(options),
        job_(job),
        document_(document_of(source)),
        textures_(job.ledger, &job.progress) {}

  std::vector<std::filesystem::path> write() {
    std::vector<std::filesystem::path> paths;
    const std::vector<int>& frames = source_.scene.frames.frames;
    const bool one_file = !has_frame_pattern(output_.filename().string());
    std::optional<RibFile> file;
    for (size_t i = 0; i < frames.size(); ++i) {
      if (!file) {
        paths.push_back(one_file ? output_
                                 : output_.parent_path() /
                                       frame_file_name(output_.filename().string(), frames[i]));
        file.emplace(paths.back(), options_.format);
        file->writer().comment(fmt::format("#Creator pelage {}", version()));
        file->writer().request("version").number(3.04f);
      }
      write_frame(file->writer(), frames[i], paths.back());
      if (one_file && i + 1 < frames.size()) continue;
      file->commit();
      file.reset();
    }
    return paths;
  }

 private:
  void write_options(RibWriter& rib) const {
    const std::string folder = absolute_text(output_).substr(0, absolute_text(output_).rfind('/') + 1);
    rib.request("Option").text("searchpath").parameter("string archive").texts({folder + ":.:@"});
    for (const char* name : {"units", "image", "render"}) {
      const Value* block = document_.find(name);
      if (!block || !block->is_map()) continue;
      rib.request("Option").text("pelage").parameter(std::string("string ") + name);
      rib.texts({yaml_text(*block)});
    }
  }

  void write_frame(RibWriter& rib, int frame, const std::filesystem::path& path) {
    const FrameParts parts = pose_frame(source_.scene, source_.assets, frame, job_);
    rib.request("FrameBegin").integer(frame);
    write_options(rib);
    std::string picture = stem_of(path);
    if (!has_frame_pattern(output_.filename().string()) && source_.scene.frames.frames.size() > 1)
      picture += fmt::format(".{:04}", frame);
    write_camera(rib, source_.scene, parts.camera, frame, content_of(parts), picture + ".exr");
    rib.request("WorldBegin");
    write_lights(rib, source_.scene, document_, frame);
    for (const FrameSkin& skin : parts.skins) write_skin_part(rib, skin);
    coats_written_.clear();
    for (const FrameCoat& coat : parts.coats) {
      job_.check_stop();
      write_coat(rib, coat, frame, path);
    }
    rib.request("WorldEnd");
    rib.request("FrameEnd");
  }

  /// The mean colour of a skin's material.
  Rgb skin_color(const FrameSkin& skin) {
    const auto [known, is_new] = skin_colors_.try_emplace({skin.skin, skin.material});
    if (is_new) {
      const Assets::Skin& on = source_.assets.skins.at(skin.skin);
      const SkinFields fields("skin '" + skin.skin + "'", *on.rest, on.cage, job_);
      const MaterialParams material =
          with_textures(source_.scene.materials.find(skin.material)->value, {textures_, &fields});
      known->second = std::visit([&](const auto& m) { return mean_color(m.color, *on.rest); }, material);
    }
    return known->second;
  }

  void begin_part(RibWriter& rib, const std::string& name, const std::string& material, const Rgb& tint,
                  const std::optional<Rgb>& mean) const {
    rib.request("AttributeBegin");
    rib.request("Attribute").text("identifier").parameter("string name").texts({name});
    if (tint != Rgb(1))
      rib.request("Attribute").text("pelage").parameter("color tint").numbers({tint.x, tint.y, tint.z});
    write_material(rib, source_.scene, document_, material, tint, mean);
  }

  void write_skin_part(RibWriter& rib, const FrameSkin& skin) {
    const SkinParams& params = source_.scene.skins.find(skin.skin)->value;
    begin_part(rib, skin.name, skin.material, skin.tint, skin_color(skin));
    write_skin(rib, source_.assets.skins.at(skin.skin).cage, params.scheme, params.boundary, skin.cages.cages,
               motion_times(source_.scene.camera, static_cast<int>(skin.cages.cages.size())));
    rib.request("AttributeEnd");
  }

  void write_coat(RibWriter& rib, const FrameCoat& coat, int frame, const std::filesystem::path& path) {
    const bool procedural = options_.coats == RibCoats::kProcedurals;
    const CoatTree tree(coat, procedural || options_.lod ? coat.lod : std::nullopt);
    const std::vector<float> times = motion_times(source_.scene.camera, coat.skin->motion_keys());
    begin_part(rib, coat.character + "." + coat.groom, coat.material, coat.tint, {});
    if (procedural) {
      HairArguments arguments;
      arguments.scene = absolute_text(source_.path);
      arguments.overrides = source_.overrides;
      std::erase_if(arguments.overrides, [](const Override& one) { return one.key == "frames"; });
      arguments.frame = frame;
      arguments.character = coat.character;
      arguments.coat = coat.groom;
      arguments.scene_camera = source_.scene.render.lod.enabled;
      write_procedural(rib, tree, arguments, job_);
    } else if (options_.coats == RibCoats::kExpanded) {
      write_expanded(rib, tree, times, job_);
    } else {
      const std::filesystem::path folder = path.parent_path() / (stem_of(path) + "_hair");
      std::vector<std::string> words{coat.character, coat.groom, std::to_string(frame)};
      // A character may have the name of an animal, and a coat on two of its parts.
      if (const int twin = ++coats_written_[words]; twin > 1) words.push_back(std::to_string(twin));
      write_archives(rib, tree, times, folder / file_name_of(words), path.parent_path(), options_.format,
                     job_);
    }
    rib.request("AttributeEnd");
  }

  const std::filesystem::path output_;
  const SceneRibSource& source_;
  const SceneRibOptions& options_;
  const Job& job_;
  const Value document_;
  TextureLibrary textures_;
  std::map<std::pair<std::string, std::string>, Rgb> skin_colors_;  // by skin and material
  std::map<std::vector<std::string>, int> coats_written_;           // in this frame, by their names
};

}  // namespace

Rgb mean_color(const Field& color, const LimitSurface& rest) {
  if (color.is_constant()) return color.color({});
  const SurfaceTopology& topology = rest.topology();
  const float middle = topology.is_triangular() ? 1.0f / 3 : 0.5f;
  Imath::V3d weighted(0), sum(0);
  double area = 0, faces = 0;
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (topology.is_hole(face)) continue;
    const SurfacePoint at = rest.evaluate(face, middle, middle);
    const V2f uv = topology.texture_coordinates(face, middle, middle);
    FieldPoint point;
    point.rest = at.position;
    point.u = uv.x;
    point.v = uv.y;
    point.face = face;
    point.face_uv = V2f(middle);
    point.normal = rest.frame(at, face, middle, middle).normal;
    const Rgb value = color.color(point);
    const auto size = static_cast<double>(at.du.cross(at.dv).length());
    weighted += size * Imath::V3d(value.x, value.y, value.z);
    sum += Imath::V3d(value.x, value.y, value.z);
    area += size;
    ++faces;
  }
  if (faces == 0) return color.color({});
  const Imath::V3d mean = area > 0 ? weighted / area : sum / faces;
  return {static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z)};
}

std::vector<std::filesystem::path> write_scene_rib(const std::filesystem::path& output,
                                                   const SceneRibSource& source,
                                                   const SceneRibOptions& options, const Job& job) {
  return SceneRibWriter(output, source, options, job).write();
}

}  // namespace pelage
