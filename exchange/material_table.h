// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/hair_model.h"
#include "exchange/scene_export.h"
#include "world/frame_coats.h"

namespace pelage {

/// A material with the tint of a character, as renderers without our fields can have it.
struct ExportedMaterial {
  std::string name;  ///< of the material in the scene, with a number behind it if it has several tints
  Rgb color{0.5f};   ///< constant or mean, with the tint
  const MaterialParams* params = nullptr;
  std::optional<HairModel> hair;  ///< empty for skins
};

/// The materials that parts of a frame use.
class MaterialTable {
 public:
  MaterialTable(const ExportSource& source, const Job& job, ExportNotes& notes)
      : source_(source), job_(job), notes_(notes) {}

  /// Returns the index in all() of the material of a skin or coat, and adds it when needed. The colour of a
  /// field is the mean over the skin, or over some strands of the coat.
  size_t of_skin(const FrameSkin& skin);
  size_t of_coat(const FrameCoat& coat);
  const std::vector<ExportedMaterial>& all() const { return all_; }

 private:
  const MaterialParams& params_of(const std::string& material) const;
  size_t add(const std::string& part, const std::string& material, const Rgb& tint, const Rgb& color);

  const ExportSource& source_;
  const Job& job_;
  ExportNotes& notes_;
  std::vector<ExportedMaterial> all_;
  std::map<std::string, size_t> known_;  // by part, material and tint
  std::set<std::string> names_;
};

}  // namespace pelage
