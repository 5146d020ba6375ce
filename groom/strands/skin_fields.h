// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "base/job.h"
#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "image/field_skin.h"

namespace pelage {

/// What fields read from a skin. Each value is computed when it is requested, and its memory is charged to
/// the ledger of the job. All arguments of the constructor must outlive this object; values may outlive it.
class SkinFields final : public FieldSkin {
 public:
  /// `name`: for messages, "skin 'rat'". `cage`: the mesh of the surface, without equal faces.
  SkinFields(std::string name, const LimitSurface& rest, const ControlMesh& cage, const Job& job);

  std::string name() const override { return name_; }
  Box3f bounds() const override { return rest_.control_bounds(); }
  ContentHash attributes_hash() const override;
  std::vector<std::string> groups() const override;
  std::shared_ptr<const SkinValues> group(const std::string& name) const override;
  std::shared_ptr<const SkinValues> vertex_colors() const override;
  std::shared_ptr<const SkinValues> curvature() const override;
  /// Looks for the boundary on a grid of each face, of at least 2 x 2 cells and of about a million cells
  /// altogether.
  std::shared_ptr<const SkinValues> distance_to_boundary(const Field& region) const override;
  std::shared_ptr<const SkinValues> distance_to_mesh(const AssetPath& mesh) const override;

 private:
  std::string name_;
  const LimitSurface& rest_;
  const ControlMesh& cage_;
  const Job& job_;
};

}  // namespace pelage
