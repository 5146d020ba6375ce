// SPDX-License-Identifier: Apache-2.0
#include "procedurals/detail/spread_follicles.h"

#include <algorithm>
#include <numeric>

namespace pelage {

std::vector<size_t> spread_follicles(const Groom& groom, size_t count) {
  const FollicleTree& follicles = groom.follicles();
  std::vector<size_t> all(follicles.size());
  std::iota(all.begin(), all.end(), size_t{0});
  count = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                    [&](size_t a, size_t b) {
                      const float of_a = groom.priority(a), of_b = groom.priority(b);
                      return of_a != of_b ? of_a < of_b : follicles.id(a) < follicles.id(b);
                    });
  all.resize(count);
  return all;
}

}  // namespace pelage
