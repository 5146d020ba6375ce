// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "geom/limit_surface.h"
#include "geom/strands.h"

namespace pelage {

struct Job;

/// Finds the point of the rest skin that is nearest to a given point, for guides and imported strands.
/// Searches a uniform tessellation, so the found addresses are only as accurate as its triangles. Immutable.
/// Thread safety: const members may be called from any thread.
class SkinBinding {
 public:
  /// Charges its memory to the ledger for its lifetime. Throws Error: kMemory, with the path `strands` of the
  /// file whose strands will be bound; kStopped when the job is stopped.
  SkinBinding(const LimitSurface& rest, const std::filesystem::path& strands, const Job& job);
  ~SkinBinding();

  /// Whether the skin has no surface, because every face is a hole.
  bool empty() const;
  /// Returns the root address of the nearest point. The skin must not be empty.
  RootAddress nearest(const V3f& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
