// SPDX-License-Identifier: Apache-2.0
#include "world/skin_memory_check.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/counted.h"
#include "base/memory_budget.h"
#include "geom/io/obj_file.h"
#include "geom/skin_memory.h"

namespace pelage {
namespace {

int64_t needed(const ControlMesh& cage, SubdivisionScheme scheme) {
  const SkinMemory memory = skin_memory(cage, scheme);
  return static_cast<int64_t>(cage.bytes() + std::max(memory.making, memory.held));
}

}  // namespace

MemoryCharge reserve_reading(const std::string& name, const SkinParams& params, const Job& job) {
  return reserve(job.ledger, MemoryTag::kSkins, obj_reading_bytes(params.mesh.path),
                 fmt::format("reading {} for skin '{}'", params.mesh.path.filename().string(), name));
}

void warn_of_equal_faces(size_t count, const std::string& position, const std::string& file, const Job& job) {
  if (count == 0) return;
  job.progress.warn(fmt::format("{}: left out {} of {}: others have the same vertices", position,
                                counted(static_cast<int64_t>(count), "face"), file));
}

MemoryCharge reserve_skin(const std::string& name, const SkinParams& params, const ControlMesh& cage,
                          const Job& job) {
  const int64_t bytes = needed(cage, params.scheme);
  std::string what = fmt::format("skin '{}' with the {} faces of {}", name, cage.face_count(),
                                 params.mesh.path.filename().string());
  if (params.scheme == SubdivisionScheme::kNone) return reserve(job.ledger, MemoryTag::kSkins, bytes, what);
  const std::string scheme = ValueReader<SubdivisionScheme>::print(params.scheme);
  const std::string flat = memory_text(needed(cage, SubdivisionScheme::kNone));
  if (cage.face_count() > SurfaceTopology::kDenseFaces) {
    job.progress.warn(
        fmt::format("{}: {}: subdivision (scheme: {}) takes up to {}; scheme: none uses the polygons as they "
                    "are and takes {}",
                    to_string(params.mesh.position), what, scheme, memory_text(bytes), flat));
  }
  what += fmt::format(", subdivided (scheme: {}; scheme: none takes {}),", scheme, flat);
  return reserve(job.ledger, MemoryTag::kSkins, bytes, what);
}

}  // namespace pelage
