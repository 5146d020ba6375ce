// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace pelage {

/// Four floats in one vector register (vector type of GCC and Clang). The operators + - * / and comparisons
/// work on each lane separately: no lane depends on another lane (law 1).
using Four = float __attribute__((vector_size(16)));

inline Four four(float x) { return Four{x, x, x, x}; }
/// smaller() and larger() return the smaller or larger value of each lane.
inline Four smaller(Four a, Four b) { return a < b ? a : b; }
inline Four larger(Four a, Four b) { return a > b ? a : b; }

/// Reads and writes four floats in a row.
inline Four load_four(const float* from) {
  Four lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void store_four(float* to, Four lanes) { std::memcpy(to, &lanes, sizeof lanes); }

/// The result of comparing two Four: all bits of a lane are set where it is true.
using FourTruths = int32_t __attribute__((vector_size(16)));

/// Returns one bit per lane, the lowest for the first: whether the comparison is true there. A loop over the
/// bits has fewer branches than tests of single lanes, which processors predict badly.
inline uint32_t lane_bits(FourTruths truths) {
#ifdef __SSE__
  return static_cast<uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Four>(truths)));
#else
  uint32_t bits = 0;
  for (uint32_t lane = 0; lane < 4; ++lane) bits |= truths[lane] ? 1u << lane : 0u;
  return bits;
#endif
}

/// Four 3D vectors, one per lane.
struct FourVectors {
  Four x, y, z;

  FourVectors operator+(const FourVectors& o) const { return {x + o.x, y + o.y, z + o.z}; }
  FourVectors operator-(const FourVectors& o) const { return {x - o.x, y - o.y, z - o.z}; }
  FourVectors operator*(Four s) const { return {x * s, y * s, z * s}; }
  Four dot(const FourVectors& o) const { return x * o.x + y * o.y + z * o.z; }
  FourVectors cross(const FourVectors& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
};

}  // namespace pelage
