// SPDX-License-Identifier: Apache-2.0
#include "lod/point_fit.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {
namespace {

// For few points, multiplying with a dense matrix is fast; its size is quadratic in their number.
constexpr size_t kMatrixPoints = 64;

using Row = std::vector<double>;
using Matrix = std::vector<Row>;

/// Weights of the points beside a parameter in [0, 1]; all others are zero.
struct Weights {
  size_t first = 0, count = 0;
  double value[4] = {};

  size_t end() const { return first + count; }
  double of(size_t point) const { return point < first || point >= end() ? 0.0 : value[point - first]; }
};
using WeightsAt = Weights (*)(size_t n, double t);

Weights spline_weights(size_t n, double t) {
  const double scaled = t * static_cast<double>(n - 1);
  const size_t segment = std::min(static_cast<size_t>(scaled), n - 2);
  const double u = scaled - static_cast<double>(segment), w = 1 - u;
  const double basis[4] = {w * w * w / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                           (3 * w * w * w - 6 * w * w + 4) / 6, u * u * u / 6};
  Weights weights;
  weights.first = segment > 0 ? segment - 1 : 0;
  weights.count = std::min(segment + 3, n) - weights.first;
  const auto at = [&](size_t point) -> double& { return weights.value[point - weights.first]; };
  for (size_t i = 0; i < 4; ++i) {
    const size_t point = segment + i;  // counted from the phantom point before the first
    if (point == 0) {
      at(0) += 2 * basis[i];
      at(1) -= basis[i];
    } else if (point == n + 1) {
      at(n - 1) += 2 * basis[i];
      at(n - 2) -= basis[i];
    } else {
      at(point - 1) += basis[i];
    }
  }
  return weights;
}

Weights hat_weights(size_t n, double t) {
  const double scaled = t * static_cast<double>(n - 1);
  const size_t segment = std::min(static_cast<size_t>(scaled), n - 2);
  const double u = scaled - static_cast<double>(segment);
  return {segment, 2, {1 - u, u}};
}

/// Solves a x = b for many right-hand sides in place, b row by row; a is symmetric and positive definite.
void solve(Matrix a, Matrix& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    const double pivot = a[i][i];
    for (double& v : a[i]) v /= pivot;
    for (double& v : b[i]) v /= pivot;
    for (size_t j = 0; j < a.size(); ++j) {
      if (j == i) continue;
      const double factor = a[j][i];
      for (size_t c = 0; c < a.size(); ++c) a[j][c] -= factor * a[i][c];
      for (size_t c = 0; c < b[i].size(); ++c) b[j][c] -= factor * b[i][c];
    }
  }
}

/// Least squares over `samples` evenly spaced parameters; with `pinned`, the end points are kept.
Matrix fit(size_t from, size_t to, size_t samples, WeightsAt weights, bool pinned) {
  const size_t first = pinned ? 1 : 0, count = to - 2 * first;
  Matrix normal(count, Row(count, 0.0)), right(count, Row(from, 0.0));
  for (size_t k = 0; k < samples; ++k) {
    const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(samples);
    const Weights wanted = weights(from, t), have = weights(to, t);
    for (size_t i = 0; i < count; ++i) {
      const double w = have.of(i + first);
      for (size_t j = 0; j < count; ++j) normal[i][j] += w * have.of(j + first);
      for (size_t p = wanted.first; p < wanted.end(); ++p) right[i][p] += w * wanted.of(p);
      if (pinned) {
        right[i][0] -= w * have.of(0);
        right[i][from - 1] -= w * have.of(to - 1);
      }
    }
  }
  solve(std::move(normal), right);
  if (!pinned) return right;
  Matrix all(to, Row(from, 0.0));
  all.front().front() = all.back().back() = 1;
  std::move(right.begin(), right.end(), all.begin() + 1);
  return all;
}

void append(const Row& row, std::vector<float>& out) {
  for (const double v : row) out.push_back(static_cast<float>(v));
}

/// Parameters at which curves are compared.
size_t steps(size_t from) { return 4 * (from - 1); }
double parameter(size_t step, size_t from) {
  return static_cast<double>(step) / static_cast<double>(steps(from));
}

}  // namespace

PointFit::PointFit(size_t from, size_t to) : from_(from), to_(to) {
  PELAGE_CHECK(to >= 4 && to < from);
  const size_t samples = 8 * (from - 1);
  const Matrix curve = fit(from, to, samples, spline_weights, true);
  for (const Row& row : curve) append(row, curve_);
  for (const Row& row : fit(from, to, samples, hat_weights, false)) append(row, values_);
  for (size_t k = 1; from <= kMatrixPoints && k < steps(from); ++k) {
    const Weights old = spline_weights(from, parameter(k, from)),
                  have = spline_weights(to, parameter(k, from));
    Row row(from);
    for (size_t p = 0; p < from; ++p) {
      row[p] = -old.of(p);
      for (size_t i = 0; i < to; ++i) row[p] += have.of(i) * curve[i][p];
    }
    append(row, error_);
  }
}

bool PointFit::stays_within(const float* points, float tolerance) const {
  const float limit = tolerance * tolerance;
  return error_.empty() ? curves_stay_within(points, limit) : matrix_stays_within(points, limit);
}

bool PointFit::matrix_stays_within(const float* points, float limit) const {
  for (size_t row = 0; row < error_.size(); row += from_) {
    float off[3] = {};
    for (size_t p = 0; p < from_; ++p) {
      for (size_t axis = 0; axis < 3; ++axis) off[axis] += error_[row + p] * points[4 * p + axis];
    }
    if (!(off[0] * off[0] + off[1] * off[1] + off[2] * off[2] <= limit)) return false;
  }
  return true;
}

bool PointFit::curves_stay_within(const float* points, float limit) const {
  std::vector<double> fewer(3 * to_, 0.0);
  for (size_t i = 0; i < to_; ++i) {
    for (size_t p = 0; p < from_; ++p) {
      for (size_t axis = 0; axis < 3; ++axis)
        fewer[3 * i + axis] += static_cast<double>(curve_[i * from_ + p]) * points[4 * p + axis];
    }
  }
  for (size_t k = 1; k < steps(from_); ++k) {
    const Weights old = spline_weights(from_, parameter(k, from_)),
                  have = spline_weights(to_, parameter(k, from_));
    double distance2 = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      double off = 0;
      for (size_t p = old.first; p < old.end(); ++p) off -= old.of(p) * points[4 * p + axis];
      for (size_t i = have.first; i < have.end(); ++i) off += have.of(i) * fewer[3 * i + axis];
      distance2 += off * off;
    }
    if (!(distance2 <= limit)) return false;
  }
  return true;
}

}  // namespace pelage
