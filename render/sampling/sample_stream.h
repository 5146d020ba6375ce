// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/hash.h"
#include "base/vector.h"

namespace pelage {

namespace detail {

/// Returns x with the order of its bits reversed.
constexpr uint32_t reverse_bits(uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Applies Owen scrambling to a number whose bits are in reversed order. Each bit is flipped or not,
/// depending only on `seed` and the bits below it, so that the map is a bijection [Burley20, section 2;
/// LaineKarras11]. The constants are those of [Vegdahl21].
constexpr uint32_t scramble_reversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Returns the second coordinate of point `index` of the Sobol sequence, with its bits in reversed order.
///
/// Take the bits of `index` as the coefficients of a polynomial p(X) over GF(2). The direction numbers of
/// this coordinate are the powers of 1 + X. The result is therefore the polynomial p(1 + X). The substitution
/// of 1 + X for X takes log2(32) = 5 steps, one line each.
constexpr uint32_t sobol_second_reversed(uint32_t index) {
  index ^= index >> 16;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 2) & 0x33333333u;
  return index ^ ((index >> 1) & 0x55555555u);
}

/// Returns the upper 24 of 32 bits as a float in [0, 1).
constexpr float fraction(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace detail

/// Random numbers in [0, 1) for one sample of one pixel: shuffled and Owen-scrambled Sobol points, padded
/// [Burley20, section 3].
///
/// Each call of next1d() or next2d() takes the next dimension: 0, 1, 2 ... In one dimension, the samples of a
/// pixel form a scrambled Sobol sequence (in 2-D, a (0, m, 2)-net). Each dimension has its own shuffled
/// order. The first 2^k samples of a pixel are therefore stratified in every dimension. Different dimensions,
/// and different pixels, are independent. A number is a pure function of (seed, x, y, sample, dimension),
/// whatever the order of calls (law 1).
///
/// To stratify a quantity over the samples of a pixel, every sample must take this quantity from the
/// same dimension. A dimension that counted the calls so far would depend on the course of the path.
/// Integrators therefore call seek() with a fixed dimension for each use.
class SampleStream {
 public:
  SampleStream(uint64_t seed, uint32_t x, uint32_t y, uint32_t sample)
      : key_(hash64(seed, random_use("sample"), x, y)), reversed_sample_(detail::reverse_bits(sample)) {}

  /// Sets the dimension of the next number.
  void seek(uint32_t dimension) { dimension_ = dimension; }
  /// Returns the dimension of the next number.
  uint32_t dimension() const { return dimension_; }

  /// Returns the random numbers of one of `count` branches of a path. The branches of all samples of a pixel
  /// are stratified together, like count times as many samples. Keeps dimension().
  SampleStream branch(uint32_t index, uint32_t count) const {
    SampleStream result = *this;
    result.key_ = mix64(key_ + random_use("branch of a path"));
    result.reversed_sample_ = detail::reverse_bits(detail::reverse_bits(reversed_sample_) * count + index);
    return result;
  }

  float next1d() {
    const uint64_t seeds = mix64(key_ + 2 * static_cast<uint64_t>(dimension_++) * kStep);
    const uint32_t index = shuffled_index(static_cast<uint32_t>(seeds));
    return scrambled(index, static_cast<uint32_t>(seeds >> 32));
  }

  V2f next2d() {
    const uint64_t at = key_ + 2 * static_cast<uint64_t>(dimension_++) * kStep;
    const uint64_t seeds = mix64(at);
    const uint64_t more_seeds = mix64(at + kStep);
    const uint32_t index = shuffled_index(static_cast<uint32_t>(seeds));
    return {scrambled(index, static_cast<uint32_t>(seeds >> 32)),
            scrambled(detail::sobol_second_reversed(index), static_cast<uint32_t>(more_seeds))};
  }

  /// Returns next2d() in x and y, and next1d() in z. These are two dimensions.
  V3f next3d() {
    const V2f xy = next2d();
    return {xy.x, xy.y, next1d()};
  }

 private:
  static constexpr uint64_t kStep = 0x9e3779b97f4a7c15ull;

  /// Returns the index of the Sobol point that this sample uses. Owen scrambling of the sample's index
  /// permutes aligned blocks of 2^k points for every k, and so preserves every net.
  uint32_t shuffled_index(uint32_t seed) const {
    return detail::reverse_bits(detail::scramble_reversed(reversed_sample_, seed));
  }
  static float scrambled(uint32_t reversed_point, uint32_t seed) {
    return detail::fraction(detail::reverse_bits(detail::scramble_reversed(reversed_point, seed)));
  }

  uint64_t key_;
  uint32_t reversed_sample_;
  uint32_t dimension_ = 0;
};

}  // namespace pelage
