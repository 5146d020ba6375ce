// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/clump_centres.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "base/job.h"
#include "base/memory_budget.h"
#include "groom/follicles/follicle_candidates.h"
#include "groom/follicles/follicles.h"
#include "groom/operators/operator_stack.h"

namespace pelage {

ClumpCentres::ClumpCentres(const PrepareContext& context, float spacing, uint64_t seed,
                           const std::function<void(StrandBatch&)>& grow)
    : points_(context.points) {
  constexpr double kMaxCentres = 4e6;
  const Job& job = context.job;
  const double area = measure_surface(*context.rest, FollicleDensity(), job).area;
  const double wanted = area / (static_cast<double>(spacing) * spacing);
  if (!(wanted <= kMaxCentres)) {
    throw Error(ErrorKind::kInput, context.position,
                fmt::format("a clump spacing of {} makes {:.3g} clumps on this skin; the limit is {:.3g}",
                            spacing, wanted, kMaxCentres));
  }
  FollicleOptions options;
  options.count = std::max<int64_t>(1, static_cast<int64_t>(wanted));
  options.seed = seed;
  options.owner = context.owner;
  options.noun = fmt::format("clump centres (spacing {})", spacing);
  const size_t curve_floats = static_cast<size_t>(points_) * 4;
  const auto kept = [&](int64_t n) {
    return n * static_cast<int64_t>(curve_floats * sizeof(float) + RootGrid::kMaxBytesPerPlace);
  };
  require_memory(
      job.ledger,
      std::max(follicle_temporary_bytes(options.count), follicle_bytes(options.count) + kept(options.count)),
      fmt::format("placing {} {} of {}", options.count, options.noun, context.owner));
  const FollicleTree centres = FollicleTree::build(*context.rest, options, job);

  const size_t count = centres.size();
  std::vector<V3f> positions(count), normals(count);
  const MemoryCharge tree(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(centres.bytes()));
  charge_ = MemoryCharge(job.ledger, MemoryTag::kGrooms, kept(static_cast<int64_t>(count)));
  curves_.resize(count * curve_floats);
  job.for_each(count, kBlockStrands, [&](WorkRange range) {
    const auto batch = std::make_unique<StrandBatch>();
    for (size_t begin = range.begin; begin < range.end; begin += kBlockStrands) {
      batch->count = std::min(kBlockStrands, range.end - begin);
      place_on_rest(*batch, *context.rest, centres, begin);
      // A centre must not have the random numbers of the strand with the same number.
      for (size_t s = 0; s < batch->count; ++s) batch->ids[s] |= uint64_t(1) << 63;
      start_strands(*batch, points_);
      grow(*batch);
      for (size_t s = 0; s < batch->count; ++s) {
        const V3f root = vector_at(batch->rest.position, s);
        positions[begin + s] = root;
        normals[begin + s] = vector_at(batch->rest.normal, s);
        float* out = &curves_[(begin + s) * curve_floats];
        V3f previous = root;
        float arc = 0;
        for (int p = 0; p < points_; ++p, out += 4) {
          const V3f point = root + batch->offset(p, s);
          arc += (point - previous).length();
          out[0] = point.x;
          out[1] = point.y;
          out[2] = point.z;
          out[3] = arc;
          previous = point;
        }
      }
    }
  });
  roots_ = RootGrid(std::move(positions), std::move(normals), kReach * spacing);
}

V3f ClumpCentres::at(size_t i, float arc, int& segment) const {
  const float* curve = &curves_[i * static_cast<size_t>(points_) * 4];
  while (segment + 2 < points_ && curve[(segment + 1) * 4 + 3] < arc) ++segment;
  const float* a = curve + segment * 4;
  const float* b = a + 4;
  const float length = b[3] - a[3];
  const float t = length > 1e-12f ? (arc - a[3]) / length : 0.0f;
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

}  // namespace pelage
