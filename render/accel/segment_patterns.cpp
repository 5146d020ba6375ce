// SPDX-License-Identifier: Apache-2.0
#include "render/accel/segment_patterns.h"

#include <bit>

namespace pelage {

void SegmentPatterns::expect(size_t segments, size_t strands) {
  const std::lock_guard lock(mutex_);
  Expected& expected = expected_[segments];
  const size_t count = std::bit_ceil(strands);
  if (count <= expected.strands) return;
  expected.strands = count;
  expected.charge = {};
  expected.charge =
      MemoryCharge(ledger_, MemoryTag::kChunks, static_cast<int64_t>(count * segments * sizeof(uint32_t)));
}

std::shared_ptr<const SegmentPatterns::Pattern> SegmentPatterns::get(uint32_t segments, uint32_t stride,
                                                                     size_t strands) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const Pattern>& known = patterns_[{segments, stride}];
  if (known && known->first_vertex.size() >= strands * segments) return known;

  // Sizes are powers of two, so that only few arrays are ever made.
  const size_t count = std::bit_ceil(strands);
  auto made = std::make_shared<Pattern>();
  made->first_vertex.reserve(count * segments);
  for (size_t s = 0; s < count; ++s) {
    for (uint32_t i = 0; i < segments; ++i) {
      made->first_vertex.push_back(static_cast<uint32_t>(s) * stride + i);
    }
  }
  const auto expected = expected_.find(segments);
  if (expected == expected_.end() || expected->second.strands < count) {
    made->charge =
        MemoryCharge(ledger_, MemoryTag::kChunks, static_cast<int64_t>(count * segments * sizeof(uint32_t)));
  }
  known = std::move(made);
  return known;
}

}  // namespace pelage
