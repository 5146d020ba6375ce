// SPDX-License-Identifier: Apache-2.0
// Part of rod_kernel.cpp: elimination of a band matrix along a chain.

/// The part of a symmetric matrix that the next elimination changes: unknowns 0 to 2 are a node, 3 the twist
/// of the segment behind it, and so on up to the third node. Eliminated unknowns leave a column of the factor
/// L and their part of the right-hand side behind.
struct Front {
  static constexpr size_t kSize = 11, kBlock = 4;
  V matrix[kSize][kSize];  // [column][row], row >= column
  V right[kSize];
  double* factor;    // of the next column
  double* solution;  // of the next unknown
  V failed;

  HWY_INLINE Front(double* factors, double* solutions, V has_failed)
      : factor(factors), solution(solutions), failed(has_failed) {
    for (size_t c = 0; c < kSize; ++c) clear(c);
  }
  HWY_INLINE void clear(size_t row) {
    for (size_t c = 0; c <= row; ++c) matrix[c][row] = zero();
    right[row] = zero();
  }
  /// Moves on by one node and one segment.
  HWY_INLINE void shift() {
    for (size_t c = kBlock; c < kSize; ++c) {
      for (size_t r = c; r < kSize; ++r) matrix[c - kBlock][r - kBlock] = matrix[c][r];
      right[c - kBlock] = right[c];
    }
    for (size_t c = kSize - kBlock; c < kSize; ++c) clear(c);
  }
  /// Eliminates the unknowns kFirst .. kEnd - 1.
  template <size_t kFirst, size_t kEnd>
  HWY_INLINE void eliminate() {
#pragma GCC unroll 11
    for (size_t c = kFirst; c < kEnd; ++c) {
      const V pivot = matrix[c][c];
      failed = choose(hn::And(pivot > zero(), pivot < all(1e300)), failed, all(1));
      const V inverse = all(1) / pivot;
#pragma GCC unroll 11
      for (size_t a = c + 1; a < kSize; ++a) {
        const V l = matrix[c][a] * inverse;
        hn::Store(l, kDoubles, factor);
        factor += kOwn;
        right[a] = right[a] - l * right[c];
#pragma GCC unroll 11
        for (size_t b = a; b < kSize; ++b) matrix[a][b] = matrix[a][b] - matrix[c][b] * l;
      }
      hn::Store(right[c] * inverse, kDoubles, solution);
      solution += kOwn;
    }
  }
  /// Solves for kRows unknowns, from the last one on. kBehind: number of unknowns behind the last one.
  template <size_t kBehind, size_t kRows>
  HWY_INLINE void substitute() {
#pragma GCC unroll 11
    for (size_t k = 0; k < kRows; ++k) {
      const size_t behind = kBehind + k;
      factor -= behind * kOwn;
      solution -= kOwn;
      V rest = hn::Load(kDoubles, solution);
#pragma GCC unroll 11
      for (size_t a = 0; a < behind; ++a)
        rest = rest - hn::Load(kDoubles, factor + a * kOwn) * hn::Load(kDoubles, solution + (a + 1) * kOwn);
      hn::Store(rest, kDoubles, solution);
    }
  }
};
