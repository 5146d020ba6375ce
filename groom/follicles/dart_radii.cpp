// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/dart_radii.h"

#include "base/hash.h"
#include "base/stoppable_sort.h"

namespace pelage {

void append_at_random(const Job& job, std::vector<AcceptedDart>& accepted, std::vector<uint32_t>& order) {
  struct Drawn {
    uint64_t number;
    AcceptedDart dart;
  };
  std::vector<Drawn> drawn(accepted.size());
  for (size_t i = 0; i < accepted.size(); ++i) {
    drawn[i] = {hash64(accepted[i].rank, random_use("follicle order")), accepted[i]};
  }
  stoppable_sort(job, drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) {
    return a.number != b.number ? a.number < b.number : a.dart.rank < b.dart.rank;
  });
  for (const Drawn& one : drawn) order.push_back(one.dart.attempt);
  accepted.clear();
}

}  // namespace pelage
