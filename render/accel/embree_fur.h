// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/ledger.h"
#include "geom/strands.h"
#include "render/accel/accel.h"

namespace pelage {

class EmbreeScene;
class Workers;

/// Embree's flat curves over one batch of strands and nothing around them: what the fur tree is measured
/// against. Thread safety: immutable; each query inside a FlushDenormals scope.
class EmbreeFur {
 public:
  /// The strands stay where they are. Curves in Embree's form and its tree are charged to
  /// MemoryTag::kChunks. `tessellation_rate`: pieces of a segment.
  EmbreeFur(const Strands& strands, bool compact, int tessellation_rate, MemoryLedger& ledger,
            const Workers& workers);
  ~EmbreeFur();

  /// Distance to the nearest hit in (near, far), infinite where there is none.
  float closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const;

 private:
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace pelage
