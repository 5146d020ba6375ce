// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/content_store.h"
#include "geom/io/strand_file.h"
#include "geom/mesh.h"
#include "image/exr.h"
#include "world/scene_schema.h"

namespace pelage {

// Texts that `pelage info` prints for each kind of file, as complete lines.

std::string describe_scene(const SceneDescription& scene);
std::string describe_strands(const StrandFile& file);
std::string describe_mesh(const ControlMesh& mesh, const std::string& source);
std::string describe_exr(const ExrImage& image);
std::string describe_cache(const StoredFile& file);

}  // namespace pelage
