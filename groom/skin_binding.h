// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "geom/limit_surface.h"
#include "geom/strands.h"

namespace pelage {

struct Job;

/// Finds the place of the rest skin nearest to a point, for what was made elsewhere: guides and imported
/// strands. By an even tessellation, so addresses are exact to its triangles. Immutable. Thread safety: const
/// members may be called from any thread.
class SkinBinding {
 public:
  /// Charged to the ledger for as long as it lives. Throws Error (kMemory), which names the file whose
  /// strands are to be bound, Error (kStopped).
  SkinBinding(const LimitSurface& rest, const std::filesystem::path& strands, const Job& job);
  ~SkinBinding();

  /// Whether there is no place to be near to: every face of the skin is a hole.
  bool empty() const;
  /// Ptex address of the nearest place. Not of an empty skin.
  RootAddress nearest(const V3f& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pelage
