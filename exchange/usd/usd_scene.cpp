// SPDX-License-Identifier: Apache-2.0
#include "exchange/usd/usd_scene.h"

#include "base/file.h"
#include "exchange/posed_frames.h"
#include "exchange/usd/usd_coat.h"
#include "exchange/usd/usd_shading.h"
#include "exchange/usd/usd_skin.h"
#include "geom/interchange/unique_names.h"

namespace pelage {
namespace {

constexpr const char* kMaterialsPath = "/scene/materials";

class UsdSceneWriter {
 public:
  UsdSceneWriter(const std::filesystem::path& folder, const ExportSource& source, ExportNotes& notes,
                 const Job& job)
      : folder_(folder),
        source_(source),
        notes_(notes),
        job_(job),
        frames_(source, job),
        materials_(source, job, notes),
        units_(fmt::format("metersPerUnit = {}\nupAxis = \"Y\"\ntimeCodesPerSecond = {}\n",
                           source.scene.units.meters_per_unit, source.scene.units.fps)) {}

  std::filesystem::path write() {
    write_parts();
    for (const ExportedMaterial& material : materials_.all())
      material_prims_.push_back(material_names_.unique(material.name));
    const std::filesystem::path path = folder_ / (source_.path.stem().string() + ".usda");
    const auto [first, last] =
        std::minmax_element(source_.scene.frames.frames.begin(), source_.scene.frames.frames.end());
    UsdWriter usd(path, fmt::format("defaultPrim = \"scene\"\nframesPerSecond = {}\nstartTimeCode = "
                                    "{}\nendTimeCode = {}\n{}",
                                    source_.scene.units.fps, *first, *last, units_));
    usd.open("def Xform \"scene\"");
    UniqueNames children;
    for (const char* taken : {"camera", "lights", "materials"}) children.unique(taken);
    for (const auto& [character, parts] : characters_) {
      usd.open(fmt::format("def Xform {} (kind = \"component\")", usd_string(children.unique(character))));
      for (const Part& part : parts) write_part(usd, part);
      usd.close();
    }
    write_materials(usd);
    write_lights(usd);
    UsdCamera camera{source_.scene.image.width,
                     source_.scene.image.height,
                     source_.scene.frames.frames,
                     {},
                     source_.scene.units.meters_per_unit};
    for (size_t i = 0; i < frames_.count(); ++i) camera.params.push_back(frames_.parts(i).camera);
    write_usd_camera(usd, "camera", camera);
    usd.close();
    usd.commit();
    return path;
  }

 private:
  /// A skin or coat in its own layer.
  struct Part {
    std::string name, file;  ///< of the prim; of the layer, relative to the stage
    size_t material = 0;
    std::optional<Box3f> extent;  ///< of a coat; empty: a skin
  };
  std::vector<Part>& parts_of(const std::string& character) {
    for (auto& [name, parts] : characters_) {
      if (name == character) return parts;
    }
    return characters_.emplace_back(character, std::vector<Part>()).second;
  }

  void write_parts() {
    const FrameParts& first = frames_.parts(0);
    make_own_folder(folder_);
    make_own_folder(folder_ / "skins");
    make_own_folder(folder_ / "coats");
    for (size_t i = 0; i < first.skins.size(); ++i) {
      const FrameSkin& skin = first.skins[i];
      if (skin.skin == kNoSkin) continue;
      const std::string character = skin.name.substr(0, skin.name.rfind('.'));
      Part part{prim_names_[character].unique(skin.skin), {}, materials_.of_skin(skin), {}};
      part.file = fmt::format("skins/{}.usda", files_.unique(skin.name));
      write_skin(i, part);
      parts_of(character).push_back(std::move(part));
    }
    for (size_t i = 0; i < first.coats.size(); ++i) {
      const FrameCoat& coat = first.coats[i];
      Part part{prim_names_[coat.character].unique(coat.groom), {}, materials_.of_coat(coat), {}};
      part.file = fmt::format("coats/{}.usda", files_.unique(coat.character + "." + coat.groom));
      part.extent = write_usd_coat(folder_ / part.file, units_, frames_, i, job_);
      if (part.extent) parts_of(coat.character).push_back(std::move(part));
    }
  }

  void write_skin(size_t index, const Part& part) {
    const FrameSkin& skin = frames_.parts(0).skins[index];
    const SkinParams& params = source_.scene.skins.find(skin.skin)->value;
    const ControlMesh& cage = source_.assets.skins.at(skin.skin).cage;
    std::vector<UsdMeshSample> samples;
    for (const size_t frame : frames_.different_skins(index)) {
      const auto& cages = frames_.parts(frame).skins[index].cages.cages;
      const std::vector<double> times = frames_.times(frame, static_cast<int>(cages.size()));
      for (size_t key = 0; key < cages.size(); ++key) {
        if (samples.empty() || times[key] > samples.back().time) samples.push_back({times[key], cages[key]});
      }
    }
    if (cage.chaikin_creases) notes_.add("skin '" + skin.skin + "'", "USD has no rule for Chaikin's creases");
    UsdWriter usd(folder_ / part.file, "defaultPrim = \"skin\"\n" + units_);
    open_usd_mesh(usd, "skin", {}, cage, params.scheme, params.boundary, samples);
    usd.close();
    usd.commit();
  }

  void write_part(UsdWriter& usd, const Part& part) {
    const char* type = part.extent ? "Xform" : "Mesh";
    const char* arc = part.extent ? "payload" : "references";
    usd.open(fmt::format("def {} {} (prepend apiSchemas = [\"MaterialBindingAPI\"{}]; prepend {} = {})", type,
                         usd_string(part.name), part.extent ? ", \"GeomModelAPI\"" : "", arc,
                         usd_asset(part.file)));
    if (part.extent) usd.box("float3[] extentsHint = ", *part.extent);
    usd.line(fmt::format("rel material:binding = <{}/{}>", kMaterialsPath, material_prims_[part.material]));
    usd.close();
  }

  void write_materials(UsdWriter& usd) {
    usd.open("def Scope \"materials\"");
    for (size_t i = 0; i < material_prims_.size(); ++i)
      write_usd_material(usd, kMaterialsPath, material_prims_[i], materials_.all()[i]);
    usd.close();
  }

  void write_lights(UsdWriter& usd) {
    usd.open("def Scope \"lights\"");
    UniqueNames names;
    for (const ExportedLight& light :
         exported_lights(source_.scene, source_.scene.frames.frames.front(), 1, notes_))
      write_usd_light(usd, names.unique(light.name), light, notes_);
    usd.close();
    if (frames_.count() > 1)
      notes_.add("lights", "keyed values of lights have their values of the first frame");
  }

  const std::filesystem::path folder_;
  const ExportSource& source_;
  ExportNotes& notes_;
  const Job& job_;
  const PosedFrames frames_;
  MaterialTable materials_;
  const std::string units_;
  UniqueNames files_, material_names_;
  std::vector<std::string> material_prims_;  // names in the stage, of materials_.all()
  std::map<std::string, UniqueNames> prim_names_;
  std::vector<std::pair<std::string, std::vector<Part>>> characters_;
};

}  // namespace

std::vector<std::filesystem::path> write_usd_scene(const std::filesystem::path& folder,
                                                   const ExportSource& source, ExportNotes& notes,
                                                   const Job& job) {
  return {UsdSceneWriter(folder, source, notes, job).write()};
}

}  // namespace pelage
