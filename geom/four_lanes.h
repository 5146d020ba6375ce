// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Four floats in one vector register (vector type of GCC and Clang). The operators + - * / and comparisons
/// work on each lane separately: no lane depends on another lane (law 1).
using Four = float __attribute__((vector_size(16)));

inline Four four(float x) { return Four{x, x, x, x}; }
/// smaller() and larger() return the smaller or larger value of each lane.
inline Four smaller(Four a, Four b) { return a < b ? a : b; }
inline Four larger(Four a, Four b) { return a > b ? a : b; }

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
