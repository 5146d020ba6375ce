// SPDX-License-Identifier: Apache-2.0
#include "lod/point_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/check.h"

namespace pelage {
namespace {

using Row = std::vector<double>;
using Matrix = std::vector<Row>;
/// Weights of n points at a parameter in [0, 1].
using Weights = std::function<Row(size_t n, double t)>;

Row spline_weights(size_t n, double t) {
  const double scaled = t * static_cast<double>(n - 1);
  const size_t segment = std::min(static_cast<size_t>(scaled), n - 2);
  const double u = scaled - static_cast<double>(segment), w = 1 - u;
  const double basis[4] = {w * w * w / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                           (3 * w * w * w - 6 * w * w + 4) / 6, u * u * u / 6};
  Row weights(n, 0.0);
  for (size_t i = 0; i < 4; ++i) {
    const size_t point = segment + i;  // counted from the phantom before the first
    if (point == 0) {
      weights[0] += 2 * basis[i];
      weights[1] -= basis[i];
    } else if (point == n + 1) {
      weights[n - 1] += 2 * basis[i];
      weights[n - 2] -= basis[i];
    } else {
      weights[point - 1] += basis[i];
    }
  }
  return weights;
}

Row hat_weights(size_t n, double t) {
  const double scaled = t * static_cast<double>(n - 1);
  const size_t segment = std::min(static_cast<size_t>(scaled), n - 2);
  const double u = scaled - static_cast<double>(segment);
  Row weights(n, 0.0);
  weights[segment] = 1 - u;
  weights[segment + 1] = u;
  return weights;
}

/// Solves a x = b for many right sides in place, b row by row; a is symmetric and positive.
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

/// Least squares over `samples` even parameters; with `pinned`, the ends are those of before.
Matrix fit(size_t from, size_t to, size_t samples, const Weights& weights, bool pinned) {
  const size_t first = pinned ? 1 : 0, count = to - 2 * first;
  Matrix normal(count, Row(count, 0.0)), right(count, Row(from, 0.0));
  for (size_t k = 0; k < samples; ++k) {
    const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(samples);
    const Row wanted = weights(from, t), have = weights(to, t);
    for (size_t i = 0; i < count; ++i) {
      const double w = have[i + first];
      for (size_t j = 0; j < count; ++j) normal[i][j] += w * have[j + first];
      for (size_t p = 0; p < from; ++p) right[i][p] += w * wanted[p];
      if (pinned) {
        right[i][0] -= w * have.front();
        right[i][from - 1] -= w * have.back();
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

void append(const Matrix& matrix, std::vector<float>& out) {
  for (const Row& row : matrix) {
    for (const double v : row) out.push_back(static_cast<float>(v));
  }
}

}  // namespace

PointFit::PointFit(size_t from, size_t to) : from_(from), to_(to) {
  PELAGE_CHECK(to >= 4 && to < from);
  const size_t samples = 8 * (from - 1);
  const Matrix curve = fit(from, to, samples, spline_weights, true);
  append(curve, curve_);
  append(fit(from, to, samples, hat_weights, false), values_);
  Matrix errors;
  const size_t steps = 4 * (from - 1);
  for (size_t k = 1; k < steps; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(steps);
    Row row = spline_weights(from, t);
    for (double& v : row) v = -v;
    const Row have = spline_weights(to, t);
    for (size_t i = 0; i < to; ++i) {
      for (size_t p = 0; p < from; ++p) row[p] += have[i] * curve[i][p];
    }
    errors.push_back(std::move(row));
  }
  append(errors, error_);
}

}  // namespace pelage
