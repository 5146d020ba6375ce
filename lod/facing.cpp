// SPDX-License-Identifier: Apache-2.0
#include "lod/facing.h"

namespace pelage {

float facing(const LodView& view, const V3f& point, const V3f& normal) {
  return normal.length2() > 0 ? normal.dot((view.open.position - point).normalized()) : 1.0f;
}

}  // namespace pelage
