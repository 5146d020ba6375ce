// SPDX-License-Identifier: Apache-2.0
#include "groom/imported.h"

#include <algorithm>
#include <optional>

#include "base/job.h"
#include "groom/attachment.h"

namespace pelage {
namespace {

StrandFile read_file_of(const GroomParams& params) {
  try {
    return read_strands(params.strands_file.path, {params.basis, params.default_width});
  } catch (const Error& error) {
    // Say where the file was named beside what is wrong with it.
    std::vector<Problem> problems = error.problems();
    if (!params.strands_file.position.file.empty()) {
      for (Problem& problem : problems) {
        const std::string in = to_string(problem.position);
        problem.message = in.empty() ? problem.message : in + ": " + problem.message;
        problem.position = params.strands_file.position;
      }
    }
    throw Error(error.kind(), std::move(problems));
  }
}

}  // namespace

ImportedStrands::ImportedStrands(const GroomParams& params, const LimitSurface* rest,
                                 const std::string& /*owner*/, const Job& job)
    : file_(read_file_of(params)) {
  const Strands& strands = file_.strands;
  const size_t count = strands.strand_count();
  std::vector<RootAddress> roots(count);
  std::vector<V3f> positions(count);
  for (size_t i = 0; i < count; ++i) positions[i] = strands.point(strands.first_point(i));
  free_ = !rest || !follow_skin(params, *rest, job, positions, roots);
  std::vector<uint32_t> ids;
  for (size_t i = 0; i < count; ++i) ids.push_back(static_cast<uint32_t>(strands.id(i)));
  follicles_ = FollicleTree::over(positions, roots, ids, params.leaf_size(), job, place_);

  for (const FollicleTree::Leaf& leaf : follicles_.leaves()) {
    StrandReach reach{0, 0, 0, std::numbers::pi_v<float>, 1};
    for (uint32_t f = leaf.begin; f < leaf.end; ++f) {
      const size_t place = place_[f];
      const V3f& root = positions[place];
      V3f previous = strands.point(strands.first_point(place));
      float arc = (previous - root).length();
      for (uint32_t p = 0; p < strands.strand_points(place); ++p) {
        const size_t index = strands.first_point(place) + p;
        const V3f point = strands.point(index);
        arc += (point - previous).length();
        previous = point;
        reach.distance = std::max(reach.distance, (point - root).length());
        reach.radius = std::max(reach.radius, strands.radius(index));
      }
      reach.length = std::max(reach.length, arc);
      reach.segments = std::max(reach.segments, static_cast<int>(strands.strand_points(place)) - 1);
    }
    reach_.push_back(reach);
  }
}

size_t ImportedStrands::run_length(size_t begin, size_t end) const {
  end = std::min(end, begin + kBlockStrands);
  size_t at = begin + 1;
  while (at < end && strand_points(at) == strand_points(begin)) ++at;
  return at - begin;
}

void ImportedStrands::place_free(StrandBatch& batch, size_t begin) const {
  for (size_t s = 0; s < batch.count; ++s) {
    batch.ids[s] = follicles_.id(begin + s);
    batch.rest.set(s, first_point(begin + s), Frame{});
    batch.u[s] = batch.v[s] = 0;
    batch.clump[s] = 0;
  }
}

void ImportedStrands::start(StrandBatch& batch, size_t begin) const {
  const Strands& strands = file_.strands;
  start_strands(batch, strand_points(begin));
  for (int p = 0; p < batch.point_count(); ++p) {
    StrandRow& radius = batch.points[static_cast<size_t>(p)].radius;
    for (size_t s = 0; s < batch.count; ++s) {
      const size_t index = strands.first_point(place_[begin + s]) + static_cast<size_t>(p);
      batch.set_offset(p, s, strands.point(index) - vector_at(batch.rest.position, s));
      radius[s] = strands.radius(index);
    }
  }
}

std::vector<StrandAttribute> ImportedStrands::attributes(std::span<const uint32_t> follicles,
                                                         std::string_view except) const {
  const Strands& strands = file_.strands;
  std::vector<StrandAttribute> result;
  for (const StrandAttribute& from : strands.attributes()) {
    if (from.name == except) continue;
    StrandAttribute to{from.name, from.frequency, from.components, {}};
    const auto width = static_cast<size_t>(from.components);
    const auto copy = [&](size_t first, size_t count) {
      const auto at = from.values.begin() + static_cast<std::ptrdiff_t>(first * width);
      to.values.insert(to.values.end(), at, at + static_cast<std::ptrdiff_t>(count * width));
    };
    if (from.frequency == AttributeClass::kConstant) {
      to.values = from.values;
    } else {
      for (const uint32_t follicle : follicles) {
        const size_t place = place_[follicle];
        if (from.frequency == AttributeClass::kPerStrand) copy(place, 1);
        if (from.frequency == AttributeClass::kPerPoint)
          copy(strands.first_point(place), strands.strand_points(place));
      }
    }
    result.push_back(std::move(to));
  }
  return result;
}

}  // namespace pelage
