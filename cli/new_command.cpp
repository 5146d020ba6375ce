// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/nearest_name.h"
#include "cli/commands.h"
#include "cli/output_files.h"
#include "geom/io/mesh_file.h"
#include "starter/starter_scene.h"

namespace pelage {
namespace {

std::optional<AxisDirection> axis_of(const std::string& flag, const std::string& text) {
  if (text.empty()) return {};
  const std::optional<AxisDirection> axis = parse_axis(text);
  if (!axis)
    throw Error(ErrorKind::kArguments, flag + " " + quote(text) + ": expected one of x, -x, y, -y, z, -z");
  return axis;
}

void check_new_output(const Options& options, const std::filesystem::path& scene) {
  const std::string kind = lower_extension(scene);
  if (kind != ".yaml" && kind != ".yml")
    throw Error(ErrorKind::kArguments, "-o " + scene.string() + ": scene files are named .yaml");
  check_replaces_none("-o", scene, {options.input});
  if (!options.starter.force && std::filesystem::exists(std::filesystem::symlink_status(scene)))
    throw Error(ErrorKind::kArguments, "-o " + scene.string() + ": the file exists; --force replaces it");
}

/// The path of the mesh as the scene must name it: relative to the scene, unless the user gave it absolutely.
std::string path_from(const std::filesystem::path& scene, const std::filesystem::path& mesh) {
  if (mesh.is_absolute()) return mesh.string();
  return std::filesystem::proximate(mesh, std::filesystem::absolute(scene).parent_path()).string();
}

}  // namespace

int run_new(const Options& options) {
  if (options.input.empty()) throw Error(ErrorKind::kArguments, "the name of the mesh is empty");
  const std::filesystem::path scene = options.output;
  check_new_output(options, scene);
  const std::optional<AxisDirection> up = axis_of("--up", options.starter.up);
  const std::optional<AxisDirection> facing = axis_of("--facing", options.starter.facing);
  if (up && facing && up->axis == facing->axis)
    throw Error(ErrorKind::kArguments, "--facing " + facing->name() + " is along --up " + up->name());
  StarterScene starter;
  starter.look = options.starter.preset.empty() ? coat_looks().front() : coat_look(options.starter.preset);
  starter.strands = options.starter.strands;
  if (lower_extension(options.input) != ".obj" && !is_usd_file(options.input) &&
      !is_alembic_file(options.input))
    throw Error(ErrorKind::kInput, {options.input, 0, 0},
                "unsupported file type; expected an .obj, .usda or .abc mesh");
  starter.mesh = path_from(scene, options.input);
  starter.shape = body_shape(read_mesh_file(options.input), options.input, up, facing);
  write_file(scene, starter_scene_text(starter));
  std::cout << fmt::format("{}: a {} coat on a body that faces {}, with {} up\n", scene.string(),
                           starter.look.name, starter.shape.facing.name(), starter.shape.up.name());
  return 0;
}

}  // namespace pelage
