// SPDX-License-Identifier: Apache-2.0
#include "lab/compare/compare_models.h"

#include <fmt/format.h>

#include "base/progress.h"
#include "lab/compare/light_side.h"
#include "render/fibre/fibre_material.h"
#include "world/camera_frame.h"

namespace pelage {
namespace {

/// The materials of a scene, converted to each model in turn.
class ModelMaterials {
 public:
  ModelMaterials(std::vector<MaterialParams> materials, std::filesystem::path tables, const Job& job)
      : materials_(std::move(materials)), tables_(std::move(tables)), job_(job) {}

  void choose(const std::string& model) {
    LambertCylinderParams white;
    white.color = Field(Rgb(1));
    white_ = with_fibre_model(white, model);
    if (auto* yan = std::get_if<YanParams>(&white_)) yan->tables.path = tables_;
    white_ = with_tables(white_, job_);
  }
  std::vector<MaterialParams> in_color() const {
    std::vector<MaterialParams> all;
    for (const MaterialParams& material : materials_) {
      const FibreParams* looks = fibre_params(material);
      if (!looks || material.index() == white_.index()) {
        all.push_back(looks ? with_tables(material, job_) : material);
      } else {
        all.push_back(white_);
        std::visit(
            [&]<class P>(P& p) {
              if constexpr (std::is_base_of_v<FibreParams, P>) {
                p.color = looks->color;
                p.opacity = looks->opacity;
              }
            },
            all.back());
      }
    }
    return all;
  }
  std::vector<MaterialParams> in_white() const {
    LambertParams skin;
    skin.color = Field(Rgb(1));
    std::vector<MaterialParams> all;
    for (const MaterialParams& material : materials_)
      all.push_back(fibre_params(material) ? white_ : MaterialParams(skin));
    return all;
  }
  const MaterialParams& white() const { return white_; }

 private:
  std::vector<MaterialParams> materials_;
  std::filesystem::path tables_;
  const Job& job_;
  MaterialParams white_;
};

/// Adds the results of one model. Throws Error (kStopped) once the user wants to stop.
void compare_model(const std::string& model, const SceneDescription& scene, const Job& job,
                   ModelMaterials& materials, FrameComparer& comparer, Comparison& comparison) {
  materials.choose(model);
  for (const LightSide& side : kLightSides) {
    const auto lights = lights_from(side, scene.camera, scene.frames.frames.front());
    ComparedFrame frame = comparer.render(materials.in_color(), lights, model, side.name);
    job.check_stop();
    job.progress.advance(1);
    job.progress.note(fmt::format("{}, light from the {}: {:.1f} CPU s, relMSE {:.3f}, mean luminance {:.3f}",
                                  model, side.name, frame.cpu_s, frame.noise, frame.luminance));
    comparison.frames.push_back(std::move(frame));
  }
  const double furnace = comparer.furnace(materials.in_white());
  job.check_stop();
  comparison.furnace[model] = furnace;
  job.progress.advance(1);
  comparison.fibres.push_back(compare_single_fibre(model, materials.white(), job));
  job.progress.advance(1);
}

}  // namespace

Comparison compare_models(const SceneDescription& scene, Assets& assets,
                          const std::vector<std::string>& models, const std::filesystem::path& folder,
                          const Job& job) {
  SceneDescription placed = scene;
  placed.camera = placed_camera(scene, assets, job);  // from which light is directed
  ModelMaterials materials(assets.materials, folder / "tables", job);
  FrameComparer comparer(placed, assets, job);
  Comparison comparison;
  // The furnace and the single fibre count as one picture each.
  const ProgressStage stage(job.progress, "compare",
                            static_cast<double>(models.size() * (kLightSides.size() + 2)));
  try {
    for (const std::string& model : models)
      compare_model(model, placed, job, materials, comparer, comparison);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kStopped) throw;
  }
  return comparison;
}

}  // namespace pelage
