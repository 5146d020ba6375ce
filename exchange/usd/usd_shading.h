// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "exchange/export_notes.h"
#include "exchange/exported_light.h"
#include "exchange/material_table.h"
#include "geom/usd/usd_writer.h"
#include "render/camera/camera.h"

namespace pelage {

/// Writes a Material prim. Skins are UsdPreviewSurface. Fibres also have the MaterialX node
/// `chiang_hair_bsdf`, for renderers that know it. `path`: path of the parent prim.
void write_usd_material(UsdWriter& usd, const std::string& path, const std::string& name,
                        const ExportedMaterial& material);

/// Writes a light of UsdLux whose `intensity` is a radiance. Images keep their absolute paths.
void write_usd_light(UsdWriter& usd, const std::string& name, const ExportedLight& light, ExportNotes& notes);

/// The cameras of the scene over all frames.
struct UsdCamera {
  int width = 1, height = 1;  ///< of the picture, in pixels
  std::vector<int> frames;
  std::vector<CameraParams> params;  ///< one per frame
  double meters_per_unit = 1;
};
void write_usd_camera(UsdWriter& usd, const std::string& name, const UsdCamera& camera);

}  // namespace pelage
