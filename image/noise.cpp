// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "image/field.h"

namespace pelage {
namespace {

// Perlin's fade curve and twelve edge gradients [Perlin02, sections 2 and 3]; lattice points are hashed
// instead of looked up in a permutation, so that the noise does not repeat every 256 cells.

/// A bijection on 32 bits whose output bits all depend on all input bits.
uint32_t mix32(uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  return x ^ (x >> 15);
}

float fade(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

/// Dot product of (x, y, z) with one of the twelve directions to the edges of a cube (four appear twice).
float gradient(uint32_t hash, float x, float y, float z) {
  const uint32_t h = hash & 15u;
  const float a = h < 8 ? x : y;
  const float b = h < 4 ? y : (h == 12 || h == 14 ? x : z);
  return ((h & 1u) ? -a : a) + ((h & 2u) ? -b : b);
}

float lerp(float t, float a, float b) { return a + t * (b - a); }

/// The sum of edge gradients is at most 1.0363538, slightly off the centre of a cell.
constexpr float kToUnit = 1.0f / 1.036354f;

/// Beyond this, neighbouring floats are lattice points: noise is zero there.
constexpr float kFarthest = 0x1p23f;

/// `Channels` values of gradient noise that share their lattice.
template <size_t Channels>
std::array<float, Channels> noise(const V3f& p, uint32_t seed) {
  std::array<float, Channels> result{};
  if (!(std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest)) return result;
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const float x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const uint32_t ix = static_cast<uint32_t>(static_cast<int32_t>(fx));
  const uint32_t iy = static_cast<uint32_t>(static_cast<int32_t>(fy));
  const uint32_t iz = static_cast<uint32_t>(static_cast<int32_t>(fz));
  float corner[Channels][8];
  const uint32_t base = mix32(seed);
  for (uint32_t i = 0; i < 8; ++i) {
    const uint32_t dx = i & 1u, dy = (i >> 1) & 1u, dz = i >> 2;
    uint32_t hash = mix32(base + (ix + dx) * 0x9e3779b1u + mix32((iy + dy) * 0x85ebca77u + mix32(iz + dz)));
    for (size_t c = 0; c < Channels; ++c) {
      corner[c][i] =
          gradient(hash, x - static_cast<float>(dx), y - static_cast<float>(dy), z - static_cast<float>(dz));
      hash >>= 8;
    }
  }
  const float u = fade(x), v = fade(y), w = fade(z);
  for (size_t c = 0; c < Channels; ++c) {
    const float* g = corner[c];
    const float near = lerp(v, lerp(u, g[0], g[1]), lerp(u, g[2], g[3]));
    const float far = lerp(v, lerp(u, g[4], g[5]), lerp(u, g[6], g[7]));
    result[c] = kToUnit * lerp(w, near, far);
  }
  return result;
}

}  // namespace

float perlin_noise(const V3f& p, uint32_t seed) { return noise<1>(p, seed)[0]; }

V3f perlin_noise3(const V3f& p, uint32_t seed) {
  const auto [x, y, z] = noise<3>(p, seed);
  return {x, y, z};
}

}  // namespace pelage
