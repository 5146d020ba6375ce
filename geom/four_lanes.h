// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pelage {

/// Four floats side by side, in the compilers' own vector type: + - * / and comparisons work per lane, and
/// lanes never depend on each other (law 1).
using Four = float __attribute__((vector_size(16)));

inline Four four(float x) { return Four{x, x, x, x}; }
inline Four smaller(Four a, Four b) { return a < b ? a : b; }
inline Four larger(Four a, Four b) { return a > b ? a : b; }

/// Vectors, one per lane.
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
