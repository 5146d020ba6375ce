// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/guide_set.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "base/job.h"
#include "base/memory_budget.h"
#include "geom/limit_surface.h"
#include "groom/strands/named_strands.h"
#include "groom/strands/resample.h"
#include "groom/strands/skin_binding.h"

namespace pelage {
namespace {

/// Median distance to the nearest other guide, over a bounded number of evenly chosen guides.
float median_spacing(const std::vector<V3f>& roots, const Job& job) {
  if (roots.size() < 2) return 0;
  const size_t step = std::max<size_t>(1, roots.size() / 1000);
  std::vector<float> nearest;
  for (size_t i = 0; i < roots.size(); i += step) {
    job.check_stop();
    float best = std::numeric_limits<float>::infinity();
    for (size_t j = 0; j < roots.size(); ++j) {
      if (j != i) best = std::min(best, (roots[i] - roots[j]).length());
    }
    nearest.push_back(best);
  }
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

}  // namespace

GuideSet::GuideSet(const GuideFile& source, const PrepareContext& context) : points_(context.points) {
  const Job& job = context.job;
  // Memory for reading, resampling and two search grids, as a multiple of the file's size.
  constexpr int64_t kOfFile = 4;
  std::error_code missing;
  const auto file_bytes = std::filesystem::file_size(source.file.path, missing);
  const MemoryCharge making =
      reserve(job.ledger, MemoryTag::kGrooms, missing ? 0 : kOfFile * static_cast<int64_t>(file_bytes),
              "reading the guides of " + source.file.path.string() + " for " + context.owner);
  const StrandFile file = read_named_strands(source.file, {source.basis, 1.0f});
  const size_t count = file.strands.strand_count();
  if (count == 0)
    throw Error(ErrorKind::kInput, source.file.position, "the guide file holds no usable strand");
  const SkinBinding binding(*context.rest, source.file.path, job);
  if (binding.empty())
    throw Error(ErrorKind::kInput, source.file.position,
                "guides need a skin with at least one face that is not a hole");
  for (size_t g = 0; g < count; ++g) {
    if (g % 256 == 0) job.check_stop();
    const std::vector<V3f> points = resample_strand(file.strands, g, points_);
    const RootAddress root = binding.nearest(points[0] * source.scale + source.translate);
    roots_.push_back(context.rest->evaluate(root.face, root.u, root.v).position);
    normals_.push_back(context.rest->frame(root.face, root.u, root.v).normal);
    float length = 0;
    for (size_t p = 0; p < points.size(); ++p) {
      offsets_.push_back((points[p] - points[0]) * source.scale);
      if (p > 0) length += (points[p] - points[p - 1]).length() * source.scale;
    }
    lengths_.push_back(length);
    longest_ = std::max(longest_, length);
  }
  spacing_ = median_spacing(roots_, job);
}

size_t GuideSet::bytes() const {
  return (roots_.capacity() + normals_.capacity() + offsets_.capacity()) * sizeof(V3f) +
         lengths_.capacity() * sizeof(float);
}

}  // namespace pelage
