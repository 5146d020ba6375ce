// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string_view>

#include "base/file.h"
#include "cli/commands.h"
#include "cli/info.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "geom/io/mesh_file.h"
#include "rib/document/rib_document.h"

namespace pelage {
namespace {

/// Whether a file could be read, but has no `what`. The error may name reasons after a semicolon.
bool is_lack(const Error& error, std::string_view what) {
  const std::string& message = error.problems().front().message;
  return message == what || message.starts_with(std::string(what) + ";");
}

/// A file of USD or Alembic may have curves, meshes or both.
std::string describe_scene_file(const Options& options) {
  try {
    return describe_strands(read_strands(options.input, {options.basis, options.default_width}));
  } catch (const Error& without_curves) {
    // Other errors would come again, or hide behind those of the meshes.
    if (!is_lack(without_curves, "has no curves")) throw;
    try {
      return describe_mesh(read_mesh_file(options.input), options.input);
    } catch (const Error& without_mesh) {
      if (is_lack(without_mesh, "has no mesh")) throw without_curves;
      throw;
    }
  }
}

std::string describe_file(const Options& options) {
  const std::filesystem::path path = options.input;
  const std::string kind = lower_extension(path);
  if (kind == ".yaml" || kind == ".yml" || is_rib(path)) {
    ProgressDisplay display(options.progress, [] { return false; });
    return describe_scene(read_scene(options, display));
  }
  if (!options.overrides.empty()) throw Error(ErrorKind::kArguments, "--set works on scene files only");
  if (is_usd_file(path) || is_alembic_file(path)) return describe_scene_file(options);
  if (is_strand_file(path))
    return describe_strands(read_strands(path, {options.basis, options.default_width}));
  if (kind == ".obj") return describe_mesh(read_mesh_file(path), options.input);
  if (kind == ".exr") return describe_exr(read_exr(path));
  if (kind == ".cache" || is_stored_file(path)) return describe_cache(StoredFile(path));
  throw Error(ErrorKind::kInput, {options.input, 0, 0},
              "unsupported file type; expected .yaml, .rib, .hair, .tfx, .usda, .abc, .obj, .exr or .cache");
}

}  // namespace

int run_info(const Options& options) {
  const std::string text = describe_file(options);  // before printing, because it may throw
  std::cout << options.input << ": " << text;
  return 0;
}

}  // namespace pelage
