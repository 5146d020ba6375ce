// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/guide_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/job.h"
#include "base/memory_budget.h"
#include "geom/curve.h"
#include "geom/limit_surface.h"
#include "groom/strands/named_strands.h"
#include "groom/strands/skin_binding.h"

namespace pelage {
namespace {

/// A guide that is nearer than this fraction of the distance between guides may be a copy.
constexpr float kCopy = 1.0f / 16;
/// A copy has its tip within this fraction of its length of the tip of the guide.
constexpr float kSameShape = 0.25f;

/// The strand as a polyline that is fine enough for measuring it.
std::vector<V3f> trace(const Strands& strands, size_t strand) {
  constexpr int kSteps = 8;
  std::vector<V3f> line;
  const uint32_t segments = segment_count(strands.basis(), strands.strand_points(strand));
  for (uint32_t k = 0; k < segments; ++k) {
    const CubicSegment segment = bezier_segment(strands, strand, k);
    for (int i = k == 0 ? 0 : 1; i <= kSteps; ++i) {
      line.push_back(curve_position(segment, static_cast<float>(i) / kSteps));
    }
  }
  return line;
}

std::vector<V3f> at_even_arcs(const std::vector<V3f>& line, int count) {
  std::vector<float> arc(line.size(), 0.0f);
  for (size_t i = 1; i < line.size(); ++i) arc[i] = arc[i - 1] + (line[i] - line[i - 1]).length();
  std::vector<V3f> result;
  size_t segment = 0;
  for (int i = 0; i < count; ++i) {
    const float wanted = arc.back() * static_cast<float>(i) / static_cast<float>(count - 1);
    while (segment + 2 < line.size() && arc[segment + 1] < wanted) ++segment;
    const float length = arc[segment + 1] - arc[segment];
    const float t = length > 0 ? std::clamp((wanted - arc[segment]) / length, 0.0f, 1.0f) : 0.0f;
    result.push_back(line[segment] + (line[segment + 1] - line[segment]) * t);
  }
  return result;
}

/// Distance from guide `g` to the nearest guide that is another one: on the same side of the skin, farther
/// than `min`, and not much nearer than the guides around it, as copies of `g` would be. Infinite if there is
/// none.
float distance_to_next(const std::vector<V3f>& roots, const std::vector<V3f>& normals, size_t g, float min) {
  constexpr size_t kAround = 16;
  std::array<float, kAround> nearest;
  size_t count = 0;
  for (size_t other = 0; other < roots.size(); ++other) {
    if (other == g || !RootGrid::same_side(normals[g], normals[other])) continue;
    const float distance = (roots[g] - roots[other]).length();
    if (count == kAround && distance >= nearest[count - 1]) continue;
    size_t at = count < kAround ? count++ : count - 1;
    for (; at > 0 && nearest[at - 1] > distance; --at) nearest[at] = nearest[at - 1];
    nearest[at] = distance;
  }
  if (count == 0) return std::numeric_limits<float>::infinity();
  const float copies = std::max(min, kCopy * nearest[count - 1]);  // the distance to the last of them
  const auto next = std::upper_bound(nearest.begin(), nearest.begin() + count, copies);
  return next == nearest.begin() + count ? std::numeric_limits<float>::infinity() : *next;
}

/// Median of distance_to_next() over a bounded number of evenly chosen guides; 0 if no guide has a next one.
float median_spacing(const std::vector<V3f>& roots, const std::vector<V3f>& normals, float min,
                     const Job& job) {
  const size_t step = std::max<size_t>(1, roots.size() / 1000);
  std::vector<float> distances;
  for (size_t i = 0; i < roots.size(); i += step) {
    job.check_stop();
    const float distance = distance_to_next(roots, normals, i, min);
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

std::vector<V3f> resample_strand(const Strands& strands, size_t strand, int count) {
  const std::vector<V3f> through = at_even_arcs(trace(strands, strand), count);
  // The ends are interpolated by construction; inside, solves (P[i-1] + 4 P[i] + P[i+1]) / 6 = Q[i] by
  // elimination (Thomas).
  std::vector<V3f> points = through;
  const size_t last = points.size() - 1;
  std::vector<float> upper(points.size(), 0.0f);
  for (size_t i = 1; i < last; ++i) {
    const float below = i > 1 ? upper[i - 1] : 0.0f;
    const float pivot = 1.0f / (4.0f - below);
    upper[i] = pivot;
    V3f right = through[i] * 6.0f - points[i - 1];
    if (i + 1 == last) right -= through[last];
    points[i] = right * pivot;
  }
  for (size_t i = last; i-- > 1;) {
    if (i + 1 < last) points[i] -= points[i + 1] * upper[i];
  }
  return points;
}

GuideSet::GuideSet(const GuideFile& source, const PrepareContext& context) : points_(context.points) {
  const Job& job = context.job;
  // Memory for reading, resampling and two search grids, as a multiple of the file's size.
  constexpr int64_t kOfFile = 4;
  std::error_code missing;
  const auto file_bytes = std::filesystem::file_size(source.file.path, missing);
  const MemoryCharge making =
      reserve(job.ledger, MemoryTag::kGrooms,
              missing ? 0 : kOfFile * (source.mirror ? 2 : 1) * static_cast<int64_t>(file_bytes),
              "reading the guides of " + source.file.path.string() + " for " + context.owner);
  StrandReadOptions options{source.basis, 1.0f};
  options.max_bytes = free_bytes(job.ledger);
  const StrandFile file = read_named_strands(source.file, options);
  const size_t count = file.strands.strand_count();
  if (count == 0)
    throw Error(ErrorKind::kInput, source.file.position, "the guide file holds no usable strand");
  const SkinBinding binding(*context.rest, source.file.path, job);
  if (binding.empty())
    throw Error(ErrorKind::kInput, source.file.position,
                "guides need a skin with at least one face that is not a hole");
  const V3f across = source.mirror ? source.mirror->normalized() : V3f(0);
  for (size_t i = 0; i < (source.mirror ? 2 * count : count); ++i) {
    if (i % 256 == 0) job.check_stop();
    std::vector<V3f> points = resample_strand(file.strands, i % count, points_);
    V3f start = points[0] * source.scale + source.translate;
    if (i >= count) {
      start -= across * (2 * across.dot(start));
      for (V3f& point : points) point -= across * (2 * across.dot(point));
    }
    const RootAddress root = binding.nearest(start);
    roots_.push_back(context.rest->evaluate(root.face, root.u, root.v).position);
    normals_.push_back(context.rest->frame(root.face, root.u, root.v).normal);
    float length = 0;
    V3f lean(0);
    for (size_t p = 0; p < points.size(); ++p) {
      offsets_.push_back((points[p] - points[0]) * source.scale);
      lean += offsets_.back();
      if (p > 0) length += (points[p] - points[p - 1]).length() * source.scale;
    }
    lengths_.push_back(length);
    leans_.push_back(lean.normalized());
    longest_ = std::max(longest_, length);
  }
  constexpr float kSamePlace = 1e-4f;  // of the skin's size
  const float same_place = kSamePlace * context.rest->control_bounds().size().length();
  spacing_ = median_spacing(roots_, normals_, same_place, job);
  drop_twins(std::max(same_place, kCopy * spacing_));
}

void GuideSet::drop_twins(float apart) {
  if (!(apart > 0)) return;
  const RootGrid grid(roots_, normals_, apart);
  const auto points = static_cast<size_t>(points_);
  std::vector<bool> kept(roots_.size(), true);
  size_t count = 0;
  for (size_t g = 0; g < roots_.size(); ++g) {
    const V3f tip = offset(g, points_ - 1);
    grid.for_each_near(roots_[g], normals_[g], [&](uint32_t other, float) {
      if (other < g && kept[other] && (tip - offset(other, points_ - 1)).length() <= kSameShape * lengths_[g])
        kept[g] = false;
    });
    count += kept[g];
  }
  if (count == kept.size()) return;
  size_t to = 0;
  for (size_t g = 0; g < kept.size(); ++g) {
    if (!kept[g]) continue;
    roots_[to] = roots_[g];
    normals_[to] = normals_[g];
    leans_[to] = leans_[g];
    lengths_[to] = lengths_[g];
    std::copy_n(offsets_.begin() + static_cast<std::ptrdiff_t>(g * points), points,
                offsets_.begin() + static_cast<std::ptrdiff_t>(to * points));
    ++to;
  }
  roots_.resize(to);
  normals_.resize(to);
  leans_.resize(to);
  lengths_.resize(to);
  offsets_.resize(to * points);
}

size_t GuideSet::bytes() const {
  return (roots_.capacity() + normals_.capacity() + offsets_.capacity() + leans_.capacity()) * sizeof(V3f) +
         lengths_.capacity() * sizeof(float);
}

}  // namespace pelage
