// SPDX-License-Identifier: Apache-2.0
#include "groom/coat/coat_source.h"

#include "groom/operators/operator_stack.h"

namespace pelage {

void CoatSource::place(StrandBatch& batch, size_t begin) const {
  if (rest) {
    place_on_rest(batch, *rest, follicles(), begin);
  } else {
    imported->place_free(batch, begin);
  }
}

void CoatSource::start(StrandBatch& batch, size_t begin) const {
  place(batch, begin);
  if (imported) {
    imported->start(batch, begin);
  } else {
    start_strands(batch, points);
  }
}

StrandReach CoatSource::reach(size_t leaf) const {
  if (imported) return imported->reach(leaf);
  StrandReach straight;
  straight.lean = 0;
  straight.segments = points - 1;
  return straight;
}

}  // namespace pelage
