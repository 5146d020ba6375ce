// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/ledger.h"
#include "geom/strands.h"
#include "render/accel/accel.h"

namespace pelage {

class EmbreeScene;
class Workers;

/// Intersects rays with a single batch of strands, as Embree's flat curves: the baseline to which the fur
/// tree is compared. Thread safety: immutable; each query inside a FlushDenormals scope.
class EmbreeFur {
 public:
  /// Reads the strands in place: they must outlive this object. Charges Embree's tree and the curve data made
  /// for Embree to MemoryTag::kChunks. `compact` and `tessellation_rate`: as in EmbreeOptions.
  EmbreeFur(const Strands& strands, bool compact, int tessellation_rate, MemoryLedger& ledger,
            const Workers& workers);
  ~EmbreeFur();

  /// Distance to the nearest hit in (near, far); infinite when there is none.
  float closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const;

 private:
  std::unique_ptr<EmbreeScene> scene_;
};

}  // namespace pelage
