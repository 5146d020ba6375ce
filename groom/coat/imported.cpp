// SPDX-License-Identifier: Apache-2.0
#include "groom/coat/imported.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "base/job.h"
#include "base/memory_budget.h"
#include "base/progress.h"
#include "base/release.h"
#include "groom/coat/attachment.h"
#include "groom/strands/named_strands.h"

namespace pelage {

ImportedStrands::ImportedStrands(const GroomParams& params, const LimitSurface* rest,
                                 const std::string& owner, const Job& job)
    : reader_(with_errors_at_asset(params.strands_file, [&] {
        StrandReadOptions options{params.basis, params.default_width};
        options.max_bytes = free_bytes(job.ledger);
        return StrandReader(params.strands_file, options, params.to_rest());
      })) {
  // Per strand: first point, root and id in the order of the file; then the retained data in the order of
  // follicles: root, id and number, at most two numbers of the reader, and the first point of a free strand
  // or, before it is known to be free, its distance to the skin.
  constexpr size_t kMaking = sizeof(V3f) + sizeof(RootAddress) + sizeof(uint32_t);
  constexpr size_t kKept = sizeof(RootAddress) + 4 * sizeof(uint32_t) + sizeof(V3f);
  const size_t claimed = reader_.strands_in_file();
  const MemoryCharge making =
      reserve(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(claimed * (kMaking + kKept)),
              fmt::format("reading the roots of {} strands of {} for {}", claimed,
                          params.strands_file.path.string(), owner));
  // The file is read twice, at about 0.1 us per point each time.
  constexpr size_t kMinForProgress = 2'000'000;
  const ProgressStage stage(job.progress, "read strands", 2 * static_cast<double>(claimed),
                            reader_.points_in_file() >= kMinForProgress);
  std::vector<V3f> positions;
  std::vector<uint32_t> ids;
  positions.reserve(claimed);
  ids.reserve(claimed);
  with_errors_at_asset(params.strands_file, [&] {
    reader_.scan(job, [&](size_t, const Strands& strands) {
      stage.advance(static_cast<double>(strands.strand_count()));
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        positions.push_back(strands.point(strands.first_point(s)));
        ids.push_back(static_cast<uint32_t>(strands.id(s)));
      }
    });
  });
  const size_t count = positions.size();
  std::vector<RootAddress> roots(count);
  free_ = !rest || !follow_skin(params, *rest, job, positions, roots);
  if (free_) release(roots);
  follicles_ = FollicleTree::over(positions, roots, ids, params.leaf_size(), job, place_);
  release(roots);
  release(ids);
  if (free_) {
    free_roots_.reserve(count);
    for (const uint32_t place : place_) free_roots_.push_back(positions[place]);
  }
  if (reader_.repairs().dropped == 0) release(place_);
  find_reach(positions, job, stage);
}

/// `roots`: of all strands, by their numbers. Reads the file sequentially once more, which costs less than
/// seeking the strands of each leaf.
void ImportedStrands::find_reach(std::span<const V3f> roots, const Job& job, const ProgressStage& stage) {
  std::vector<uint32_t> leaf_of(roots.size());
  for (uint32_t leaf = 0; leaf < follicles_.leaves().size(); ++leaf) {
    const FollicleTree::Leaf& range = follicles_.leaves()[leaf];
    for (uint32_t f = range.begin; f < range.end; ++f) leaf_of[places()[f]] = leaf;
  }
  reach_.assign(follicles_.leaves().size(), {0, 0, 0, std::numbers::pi_v<float>, 1});
  reader_.read_all(job, [&](size_t first, const Strands& strands) {
    stage.advance(static_cast<double>(strands.strand_count()));
    for (size_t s = 0; s < strands.strand_count(); ++s) {
      StrandReach& reach = reach_[leaf_of[first + s]];
      const V3f& root = roots[first + s];
      V3f previous = strands.point(strands.first_point(s));
      float arc = (previous - root).length();
      for (uint32_t p = 0; p < strands.strand_points(s); ++p) {
        const size_t index = strands.first_point(s) + p;
        const V3f point = strands.point(index);
        arc += (point - previous).length();
        previous = point;
        reach.distance = std::max(reach.distance, (point - root).length());
        reach.radius = std::max(reach.radius, strands.radius(index));
      }
      reach.length = std::max(reach.length, arc);
      reach.segments = std::max(reach.segments, static_cast<int>(strands.strand_points(s)) - 1);
    }
  });
}

/// Reads follicles of one leaf.
Strands ImportedStrands::read(size_t begin, size_t end) const {
  return reader_.read(places().subspan(begin, end - begin));
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
    batch.u[s] = batch.v[s] = batch.face_u[s] = batch.face_v[s] = 0;
    batch.face[s] = 0;
    batch.clump[s] = 0;
  }
}

void ImportedStrands::start(StrandBatch& batch, size_t begin) const {
  const Strands strands = read(begin, begin + batch.count);
  start_strands(batch, strand_points(begin));
  for (int p = 0; p < batch.point_count(); ++p) {
    StrandRow& radius = batch.points[static_cast<size_t>(p)].radius;
    for (size_t s = 0; s < batch.count; ++s) {
      const size_t index = strands.first_point(s) + static_cast<size_t>(p);
      batch.set_offset(p, s, strands.point(index) - vector_at(batch.rest.position, s));
      radius[s] = strands.radius(index);
    }
  }
}

std::vector<StrandAttribute> ImportedStrands::attributes(std::span<const uint32_t> follicles,
                                                         std::string_view except) const {
  std::vector<StrandAttribute> result;
  bool varies = false;
  for (const StrandAttribute& attribute : reader_.attributes()) {
    if (attribute.name == except) continue;
    result.push_back(attribute);
    varies |= attribute.frequency != AttributeClass::kConstant;
  }
  // A few strands at a time, because their points are read as well.
  std::vector<uint32_t> wanted;
  for (size_t begin = 0; varies && begin < follicles.size(); begin += kBlockStrands) {
    wanted.clear();
    for (const uint32_t f : follicles.subspan(begin, std::min(kBlockStrands, follicles.size() - begin)))
      wanted.push_back(places()[f]);
    const Strands strands = reader_.read(wanted);
    for (StrandAttribute& to : result) {
      if (to.frequency == AttributeClass::kConstant) continue;
      const std::vector<float>& from = strands.find_attribute(to.name)->values;
      to.values.insert(to.values.end(), from.begin(), from.end());
    }
  }
  return result;
}

size_t ImportedStrands::attribute_floats(size_t begin, size_t end, std::string_view except) const {
  size_t points = 0, floats = 0;
  for (size_t f = begin; f < end; ++f) points += static_cast<size_t>(strand_points(f));
  for (const StrandAttribute& attribute : reader_.attributes()) {
    if (attribute.name == except) continue;
    floats += static_cast<size_t>(attribute.components) *
              (attribute.frequency == AttributeClass::kConstant    ? 1
               : attribute.frequency == AttributeClass::kPerStrand ? end - begin
                                                                   : points);
  }
  return floats;
}

size_t ImportedStrands::bytes() const {
  return reader_.bytes() + follicles_.bytes() + place_.capacity() * sizeof(uint32_t) +
         free_roots_.capacity() * sizeof(V3f) + reach_.capacity() * sizeof(StrandReach);
}

}  // namespace pelage
