// SPDX-License-Identifier: Apache-2.0
#include "exchange/still_scene.h"

#include <cmath>

#include "base/file.h"
#include "geom/interchange/unique_names.h"

namespace pelage {
namespace {

class StillWriter {
 public:
  StillWriter(const std::filesystem::path& folder, const ExportSource& source, const std::string& ending,
              const WriteLeaf& write_leaf, ExportNotes& notes, const Job& job)
      : folder_(folder),
        source_(source),
        ending_(ending),
        write_leaf_(write_leaf),
        notes_(notes),
        job_(job),
        materials_(source, job, notes) {
    make_own_folder(folder);
    make_own_folder(folder / "skins");
    make_own_folder(folder / "coats");
  }

  StillScene write(int frame, const std::string& suffix) {
    const FrameParts parts = pose_frame(source_.scene, source_.assets, frame, job_);
    const ImageParams& image = source_.scene.image;
    StillScene scene{{}, {}, {}, {}, parts.camera, Camera(parts.camera, frame, image.width, image.height)};
    bool moves = false;
    for (const FrameSkin& skin : parts.skins) {
      if (skin.skin == kNoSkin) continue;
      moves |= skin.posed->motion_keys() > 1;
      const std::string file = fmt::format("skins/{}{}.ply", names_.unique(skin.name + suffix), "");
      if (write_ply(folder_ / file, skin, scene.view.view(), job_) == 0) continue;
      scene.skins.push_back({skin.name, {file}, materials_.of_skin(skin)});
    }
    for (const FrameCoat& coat : parts.coats) {
      moves |= coat.skin->motion_keys() > 1;
      write_coat(coat, suffix, scene);
    }
    if (moves || !source_.scene.camera.position.is_constant())
      notes_.add("motion", "there is no motion blur: everything is where it is in the middle of the shutter");
    scene.materials = materials_.all();
    scene.lights = exported_lights(source_.scene, frame, std::exp2(parts.camera.exposure.at(frame)), notes_);
    for (size_t i = 0; i < scene.lights.size(); ++i) write_mesh(suffix, i, scene);
    return scene;
  }

 private:
  void write_coat(const FrameCoat& coat, const std::string& suffix, StillScene& scene) {
    const std::string name = coat.character + "." + coat.groom, stem = names_.unique(name + suffix);
    const CoatTree tree(coat, std::nullopt);
    std::vector<char> written(tree.all().end, 0);
    const auto file = [&](size_t leaf) { return fmt::format("coats/{}.{}{}", stem, leaf, ending_); };
    for_each_leaf_at_once(tree, job_, [&](size_t leaf) {
      const Strands strands = still_strands(tree.grow(leaf));
      if (strands.strand_count() == 0) return;
      write_leaf_(folder_ / file(leaf), strands);
      written[leaf] = 1;
    });
    StillScene::Part part{name, {}, materials_.of_coat(coat)};
    for (size_t leaf = 0; leaf < written.size(); ++leaf) {
      if (written[leaf]) part.files.push_back(file(leaf));
    }
    if (!part.files.empty()) scene.coats.push_back(std::move(part));
  }

  /// The mesh of a light becomes a file; `image` of the light is then its name.
  void write_mesh(const std::string& suffix, size_t index, StillScene& scene) {
    ExportedLight& light = scene.lights[index];
    if (light.kind != ExportedLight::Kind::kMesh) return;
    light.image = fmt::format("skins/{}.ply", names_.unique("light." + light.name + suffix));
    write_ply(folder_ / light.image, light.mesh);
  }

  const std::filesystem::path folder_;
  const ExportSource& source_;
  const std::string ending_;
  const WriteLeaf& write_leaf_;
  ExportNotes& notes_;
  const Job& job_;
  MaterialTable materials_;
  UniqueNames names_;
};

}  // namespace

void for_each_still(const std::filesystem::path& folder, const ExportSource& source,
                    const std::string& ending, const WriteLeaf& write_leaf, ExportNotes& notes,
                    const Job& job, const std::function<void(const StillScene&, const std::string&)>& use) {
  StillWriter writer(folder, source, ending, write_leaf, notes, job);
  const std::vector<int>& frames = source.scene.frames.frames;
  for (const int frame : frames) {
    const std::string suffix = frames.size() > 1 ? fmt::format(".{:04}", frame) : "";
    use(writer.write(frame, suffix), source.path.stem().string() + suffix);
  }
}

}  // namespace pelage
