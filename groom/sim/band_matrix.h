// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pelage {

/// A symmetric positive definite matrix whose nonzero elements lie within kBand of the diagonal, and the
/// right-hand side of a linear system. Stores the lower triangle, column by column.
class BandMatrix {
 public:
  static constexpr size_t kBand = 10;
  using Column = std::array<double, kBand + 2>;  // of even length, for vector instructions

  /// Sets the size and clears all elements and the right-hand side. Keeps its memory.
  void reset(size_t size) {
    size_ = size;
    columns_.assign(size + kBand, {});
    right_.assign(size + kBand, 0.0);
  }
  size_t size() const { return size_; }
  /// Element (row, column), for column <= row <= column + kBand.
  double& at(size_t row, size_t column) { return columns_[column][row - column]; }
  /// Elements (column, column), (column + 1, column), ...
  Column& column(size_t column) { return columns_[column]; }
  double& right(size_t row) { return right_[row]; }

  /// Solves the system by a Cholesky decomposition in place. Afterwards, right() is the solution. Returns
  /// false if a pivot is not positive or not finite.
  bool solve() {
    for (size_t j = 0; j < size_; ++j) {
      Column& column = columns_[j];
      if (!(column[0] > 0) || !std::isfinite(column[0])) return false;
      const double inverse = 1 / std::sqrt(column[0]);
      for (double& element : column) element *= inverse;
      column[0] = inverse;  // the diagonal of the factor is stored as its reciprocal
      const double here = right_[j] *= inverse;
#pragma GCC unroll 10
      for (size_t a = 1; a <= kBand; ++a) {
        Column& other = columns_[j + a];
        const double factor = column[a];
        right_[j + a] -= factor * here;
        for (size_t b = a; b <= kBand; ++b) other[b - a] -= factor * column[b];
      }
    }
    for (size_t i = size_; i-- > 0;) {
      double rest = right_[i];
      for (size_t a = 1; a <= kBand; ++a) rest -= columns_[i][a] * right_[i + a];
      right_[i] = rest * columns_[i][0];
    }
    return true;
  }

 private:
  size_t size_ = 0;
  std::vector<Column> columns_;  // kBand more than the size, all zero, so that loops need no limits
  std::vector<double> right_;
};

}  // namespace pelage
