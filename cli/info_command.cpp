// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <string_view>

#include "base/file.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/info.h"
#include "cli/progress_display.h"
#include "cli/read_scene.h"
#include "geom/io/mesh_file.h"
#include "geom/io/obj_file.h"
#include "image/exr_file.h"
#include "rib/document/rib_document.h"

namespace pelage {
namespace {

/// Whether a file could be read, but has no `what`. The error may name reasons after a semicolon.
bool is_lack(const Error& error, std::string_view what) {
  const std::string& message = error.problems().front().message;
  return message == what || message.starts_with(std::string(what) + ";");
}

std::string describe_strand_file(const Options& options) {
  return describe_strands(
      read_strands(options.input, {options.basis, options.default_width, false, options.memory}));
}

std::string describe_mesh_file(const Options& options) {
  MemoryLedger ledger;
  ledger.set_limit(static_cast<uint64_t>(options.memory), "--memory");
  NoProgress progress;
  const Workers workers(1);
  // The readers of USD and Alembic charge the memory that they use.
  if (lower_extension(options.input) == ".obj")
    require_memory(ledger, obj_reading_bytes(options.input), "reading " + options.input);
  return describe_mesh(read_mesh_file(options.input, {workers, ledger, progress}), options.input);
}

std::string describe_exr_file(const Options& options) {
  int64_t words = 0, buffers = 0;
  {
    const ExrReader header(options.input);
    const ExrPart& part = header.parts().front();
    words = int64_t{part.data.width()} * part.data.height() * static_cast<int64_t>(part.channels.size());
    buffers = header.buffer_bytes();
  }
  MemoryLedger ledger;
  ledger.set_limit(static_cast<uint64_t>(options.memory), "--memory");
  require_memory(ledger, buffers + 4 * words, "reading " + options.input);
  return describe_exr(read_exr(options.input));
}

/// A file of USD or Alembic may have curves, meshes or both.
std::string describe_scene_file(const Options& options) {
  try {
    return describe_strand_file(options);
  } catch (const Error& without_curves) {
    // Other errors would come again, or hide behind those of the meshes.
    if (!is_lack(without_curves, "has no curves")) throw;
    try {
      return describe_mesh_file(options);
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
  if (options.set_count > 0) throw Error(ErrorKind::kArguments, "--set works on scene files only");
  if (is_usd_file(path) || is_alembic_file(path)) return describe_scene_file(options);
  if (is_strand_file(path)) return describe_strand_file(options);
  if (kind == ".obj") return describe_mesh_file(options);
  if (kind == ".exr") return describe_exr_file(options);
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
