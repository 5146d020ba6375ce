// SPDX-License-Identifier: Apache-2.0
#include "why/material_why.h"

#include <variant>

#include "render/frame/frame_shading.h"
#include "render/frame/strand_fields.h"

namespace pelage {
namespace {

float opacity_at(const RenderScene& frame, const SeenSurface& surface) {
  const FurPart& part = frame.fur[surface.hit.part];
  const Strands& strand = surface.met.strand;
  const FibreParams& fibre = *fibre_params(frame.materials[part.material]);
  std::vector<float> opacities = point_opacities(fibre.opacity, strand, part);
  if (opacities.empty()) return 1;
  const StrandAttribute opacity{"opacity", AttributeClass::kPerPoint, 1, std::move(opacities)};
  float value = 1;
  interpolate_attribute(strand, opacity, 0, surface.hit.segment, surface.hit.u, &value);
  return value;
}

}  // namespace

MaterialWhy explain_material(const SceneDescription& scene, const RenderScene& frame,
                             const SeenSurface& surface) {
  const bool is_strand = surface.hit.kind == HitKind::kStrand;
  const size_t index =
      is_strand ? frame.fur[surface.hit.part].material : frame.skins[surface.hit.part].material;
  const auto& item = scene.materials.items[index];
  MaterialWhy why;
  why.name = item.name;
  std::visit(
      [&]<class P>(const P& params) {
        why.model = P::kTypeName;
        why.parameters = P::schema().describe(params);
      },
      item.value);
  why.color = FrameShading(frame).color(surface.hit, surface.met);
  if (is_strand) why.opacity = opacity_at(frame, surface);
  return why;
}

}  // namespace pelage
