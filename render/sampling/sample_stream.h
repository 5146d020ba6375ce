// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/hash.h"
#include "base/vector.h"

namespace pelage {

namespace detail {

constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Owen scrambling of a number with reversed bits: a bijection in which every bit is flipped by a function of
/// the bits below it [Burley20, section 2; LaineKarras11], with the constants of [Vegdahl21].
constexpr uint32_t scramble_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Second coordinate of the Sobol sequence, bits reversed: its direction numbers are the powers of 1 + X over
/// GF(2), so that the point of index p(X) is p(X + 1), and shifting a polynomial by one takes log2(32) steps.
constexpr uint32_t sobol_second_reversed(uint32_t index) {
  index ^= index >> 16;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 2) & 0x33333333u;
  return index ^ ((index >> 1) & 0x55555555u);
}

/// The upper 24 of 32 bits as a float in [0, 1).
constexpr float fraction(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace detail

/// Random numbers of one sample of one pixel, in [0, 1): shuffled and Owen-scrambled Sobol points, padded
/// [Burley20, section 3]. Each draw uses its own 1-D or 2-D (0, m, 2)-net in its own order, so that the first
/// 2^k samples of a pixel are stratified in every draw, and any two draws and any two pixels are independent.
/// A pure function of (seed, x, y, sample, dimension): the same for any order of evaluation (law 1).
///
/// Draws are numbered; a 2-D draw counts as one. Quantities that must be stratified across samples must use
/// the same draw in all of them, so integrators seek() to fixed positions instead of counting the draws of a
/// path.
class SampleStream {
 public:
  SampleStream(uint64_t seed, uint32_t x, uint32_t y, uint32_t sample)
      : key_(hash64(seed, random_use("sample"), x, y)), reversed_sample_(detail::reverse_bits(sample)) {}

  /// Sets the number of the next draw.
  void seek(uint32_t draw) { draw_ = draw; }
  uint32_t draw() const { return draw_; }

  float next1d() {
    const uint64_t seeds = mix64(key_ + 2 * static_cast<uint64_t>(draw_++) * kStep);
    const uint32_t index = shuffled_index(static_cast<uint32_t>(seeds));
    return scrambled(index, static_cast<uint32_t>(seeds >> 32));
  }

  V2f next2d() {
    const uint64_t at = key_ + 2 * static_cast<uint64_t>(draw_++) * kStep;
    const uint64_t seeds = mix64(at);
    const uint64_t more_seeds = mix64(at + kStep);
    const uint32_t index = shuffled_index(static_cast<uint32_t>(seeds));
    return {scrambled(index, static_cast<uint32_t>(seeds >> 32)),
            scrambled(detail::sobol_second_reversed(index), static_cast<uint32_t>(more_seeds))};
  }

  /// next2d() in x and y, next1d() in z: two draws.
  V3f next3d() {
    const V2f xy = next2d();
    return {xy.x, xy.y, next1d()};
  }

 private:
  static constexpr uint64_t kStep = 0x9e3779b97f4a7c15ull;

  /// Owen-scrambling the index permutes aligned blocks of 2^k points for every k, and so preserves every net.
  uint32_t shuffled_index(uint32_t seed) const {
    return detail::reverse_bits(detail::scramble_reversed(reversed_sample_, seed));
  }
  static float scrambled(uint32_t reversed_point, uint32_t seed) {
    return detail::fraction(detail::reverse_bits(detail::scramble_reversed(reversed_point, seed)));
  }

  uint64_t key_;
  uint32_t reversed_sample_;
  uint32_t draw_ = 0;
};

}  // namespace pelage
