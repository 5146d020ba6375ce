// SPDX-License-Identifier: Apache-2.0
#include "exchange/material_table.h"

#include <algorithm>

#include <fmt/format.h>

#include "render/frame/strand_fields.h"
#include "rib/host/coat_tree.h"
#include "rib/host/scene_rib.h"

namespace pelage {
namespace {

constexpr size_t kColorLeaves = 4, kColorStrands = 256;

/// The mean colour of some strands: of a few leaves, at a quarter, half and three quarters of each strand.
Rgb mean_strand_color(const Field& color, const FrameCoat& coat) {
  const CoatTree tree(coat, std::nullopt);
  const size_t leaves = tree.all().end, step = std::max<size_t>(1, leaves / kColorLeaves);
  V3d sum(0);
  double count = 0;
  for (size_t leaf = step / 2; leaf < leaves; leaf += step) {
    const Strands strands = tree.grow(leaf);
    const auto attributes = find_attributes(color, strands, coat.character + "." + coat.groom);
    const size_t skip = std::max<size_t>(1, strands.strand_count() / kColorStrands);
    for (size_t s = 0; s < strands.strand_count(); s += skip) {
      const uint32_t segments = segment_count(strands.basis(), strands.strand_points(s));
      for (const float v : {0.25f, 0.5f, 0.75f}) {
        const float place = v * static_cast<float>(segments);
        const auto segment = std::min(static_cast<uint32_t>(place), segments - 1);
        const Rgb value = strand_color(color, strands, attributes, coat.rest.get(),
                                       {s, segment, place - static_cast<float>(segment), v});
        sum += V3d(value.x, value.y, value.z);
        ++count;
      }
    }
  }
  if (count == 0) return Rgb(0.5f);
  sum /= count;
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

}  // namespace

const MaterialParams& MaterialTable::params_of(const std::string& material) const {
  const auto& items = source_.scene.materials.items;
  for (size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == material) return source_.assets.materials.at(i);
  }
  throw Error(ErrorKind::kInput, "there is no material '" + material + "'");
}

size_t MaterialTable::add(const std::string& part, const std::string& material, const Rgb& tint,
                          const Rgb& color) {
  const MaterialParams& params = params_of(material);
  ExportedMaterial added;
  added.name = material;
  for (int twin = 2; !names_.insert(added.name).second; ++twin) {
    do added.name = fmt::format("{}_{}", material, twin);
    while (source_.scene.materials.find(added.name) && ++twin);
  }
  added.color = color * tint;
  added.params = &params;
  if (const FibreParams* fibre = fibre_params(params)) {
    added.hair = hair_model(params, added.color, material, notes_);
    if (!fibre->color.is_constant())
      notes_.add("material '" + material + "'", "its colour became the mean colour of the coat, " + part);
    if (!is_opaque(fibre->opacity)) notes_.add("material '" + material + "'", "its opacity is lost");
  }
  all_.push_back(std::move(added));
  return all_.size() - 1;
}

size_t MaterialTable::of_skin(const FrameSkin& skin) {
  const Field& color =
      std::visit([](const auto& m) -> const Field& { return m.color; }, params_of(skin.material));
  const bool constant = color.is_constant();
  const Rgb& t = skin.tint;
  const std::string key =
      fmt::format("{} {} {} {} {}", skin.material, t.x, t.y, t.z, constant ? std::string() : skin.skin);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  if (!constant)
    notes_.add("material '" + skin.material + "'", "its colour became its mean on skin '" + skin.skin + "'");
  const Rgb mean = mean_color(color, *source_.assets.skins.at(skin.skin).rest);
  return known_[key] = add(skin.name, skin.material, skin.tint, mean);
}

size_t MaterialTable::of_coat(const FrameCoat& coat) {
  const Field& color = fibre_params(params_of(coat.material))->color;
  const bool constant = color.is_constant();
  const Rgb& t = coat.tint;
  const std::string key =
      fmt::format("{} {} {} {} {}", coat.material, t.x, t.y, t.z, constant ? std::string() : coat.groom);
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  job_.check_stop();
  const Rgb mean = constant ? color.color({}) : mean_strand_color(color, coat);
  return known_[key] = add(coat.character + "." + coat.groom, coat.material, coat.tint, mean);
}

}  // namespace pelage
