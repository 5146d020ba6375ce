// SPDX-License-Identifier: Apache-2.0
#include "groom/follicles/follicle_candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/job.h"
#include "base/stoppable_sort.h"
#include "groom/follicles/keyed_sort.h"
#include "groom/strands/rotation.h"

namespace pelage {
namespace {

float area_element(const SurfacePoint& point) { return point.du.cross(point.dv).length(); }

// Ptex parameters cover the unit square; on a triangle (Loop), they cover its lower half.
bool is_triangular(const LimitSurface& rest) { return rest.topology().is_triangular(); }

FaceStatistics measure_face(const LimitSurface& rest, const FollicleDensity& density, uint32_t face,
                            int grid) {
  FaceStatistics result;
  if (rest.topology().is_hole(face)) return result;
  const bool triangle = is_triangular(rest);
  // Gauss-Legendre points and weights of order 4 on [0, 1].
  constexpr float kPlace[] = {0.0694318442f, 0.3300094782f, 0.6699905218f, 0.9305681558f};
  constexpr double kWeight[] = {0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      // A triangle is the square with one side collapsed, (a, b) -> (a, b (1 - a)).
      const float u = kPlace[i], v = triangle ? kPlace[j] * (1 - u) : kPlace[j];
      const float element = area_element(rest.evaluate(face, u, v));
      result.area += kWeight[i] * kWeight[j] * (triangle ? 1 - u : 1) * element;
      result.largest_element = std::max(result.largest_element, element);
    }
  }
  if (!(result.area > 0)) return {};
  double weighted = 0, weights = 0;
  for (int i = 0; i < grid; ++i) {
    for (int j = 0; j < grid; ++j) {
      const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(grid);
      const float v = (static_cast<float>(j) + 0.5f) / static_cast<float>(grid);
      if (triangle && u + v > 1) continue;
      const SurfacePoint point = rest.evaluate(face, u, v);
      const float element = area_element(point);
      const float value = density.at(rest.topology(), {face, u, v}, point);
      result.largest_element = std::max(result.largest_element, element);
      result.largest_density = std::max(result.largest_density, value);
      weighted += static_cast<double>(element) * value;
      weights += element;
    }
  }
  if (weights > 0) result.mass = result.area * weighted / weights;
  return result;
}

std::vector<FaceStatistics> measure_faces(const LimitSurface& rest, const FollicleDensity& density,
                                          const Job& job) {
  const size_t faces = rest.topology().face_count();
  const bool uniform = density.is_uniform();
  const int grid =
      uniform ? 4
              : static_cast<int>(std::clamp(
                    std::sqrt(262144.0 / static_cast<double>(std::max<size_t>(faces, 1))), 4.0, 32.0));
  std::vector<FaceStatistics> result(faces);
  job.for_each(faces, 16, [&](WorkRange range) {
    for (size_t f = range.begin; f < range.end; ++f) {
      result[f] = measure_face(rest, density, static_cast<uint32_t>(f), grid);
    }
  });
  return result;
}

/// A random point on a face, uniform by area.
struct Place {
  RootAddress root;
  SurfacePoint point;
  V3f normal;
};

Place place_on_face(const LimitSurface& rest, uint32_t face, const FaceStatistics& statistics,
                    uint64_t stream) {
  Place place{{face, 0, 0}, {}, V3f(0)};
  const float limit = statistics.largest_element * 1.1f;
  // Rejection against |du x dv|; after 64 failures (a nearly degenerate face) any point.
  for (uint64_t attempt = 0; attempt < 64; ++attempt) {
    const uint64_t h = hash64(stream, attempt);
    place.root.u = unit_float(h);
    place.root.v = unit_float(mix64(h));
    if (is_triangular(rest) && place.root.u + place.root.v > 1) {
      place.root.u = 1 - place.root.u;
      place.root.v = 1 - place.root.v;
    }
    place.point = rest.evaluate(face, place.root.u, place.root.v);
    place.normal = place.point.du.cross(place.point.dv);
    if (unit_float(mix64(h + 1)) * limit < place.normal.length()) break;
  }
  return place;
}

/// Writes such a place to `out` with probability density / bound; otherwise returns false.
bool try_candidate(const LimitSurface& rest, const FollicleDensity& density, uint32_t face,
                   const FaceStatistics& statistics, float room, uint64_t stream, FollicleCandidate& out) {
  const Place place = place_on_face(rest, face, statistics, stream);
  const float value = density.at(rest.topology(), place.root, place.point);
  const float bound = statistics.largest_density * room;
  if (!(unit_float(hash64(stream, random_use("density"))) * bound < value)) return false;
  const V3f& at = place.point.position;
  out = {at.x, at.y, at.z, pack_normal(normalised_or(place.normal, V3f(0, 0, 1))), 1.0f / std::sqrt(value),
         0,    0};
  return true;
}

}  // namespace

CandidateSupply::CandidateSupply(const FollicleCandidates& source, size_t parts, const Job& job)
    : source_(source), parts_(parts) {
  if (parts_ > 1) {
    survey_ = source_.survey(job);
    return;
  }
  all_ = source_.make_ranked(job);
  for (const FollicleCandidate& candidate : all_) survey_.add(candidate);
  job.progress.advance(1);  // as much as a survey of its own
}

std::vector<FollicleCandidate> CandidateSupply::next(const Job& job) {
  if (parts_ == 1) {
    stoppable_sort(job, all_.begin(), all_.end(), [](const FollicleCandidate& a, const FollicleCandidate& b) {
      return a.number < b.number;
    });
    return take_all();
  }
  const auto border = [this](size_t part) { return (uint64_t(1) << 32) * part / parts_; };
  std::vector<FollicleCandidate> candidates = source_.make(job, {border(part_), border(part_ + 1)});
  ++part_;
  for (FollicleCandidate& candidate : candidates) candidate.number = static_cast<uint32_t>(supplied_++);
  return candidates;
}

std::vector<FollicleCandidate> CandidateSupply::take_all() {
  PELAGE_CHECK(parts_ == 1 && part_ == 0);
  part_ = 1;
  supplied_ = all_.size();
  return std::move(all_);
}

FollicleDensity::FollicleDensity(Field field, std::function<float(const FieldPoint& root)> coverage)
    : field_(std::move(field)),
      coverage_(std::move(coverage)),
      uniform_(field_.is_constant() && !coverage_),
      needs_normal_(coverage_ || field_.dependence().normal) {}

float FollicleDensity::at(const SurfaceTopology& topology, const RootAddress& address,
                          const SurfacePoint& point) const {
  if (uniform_) return std::max(field_.value({}), 0.0f);
  FieldPoint place;
  place.rest = point.position;
  const V2f uv = topology.texture_coordinates(address.face, address.u, address.v);
  place.u = uv.x;
  place.v = uv.y;
  place.face = address.face;
  place.face_uv = {address.u, address.v};
  if (needs_normal_) place.normal = LimitSurface::frame_of(point).normal;
  float value = field_.value(place);
  if (coverage_ && value > 0) value *= coverage_(place);
  return value > 0 && std::isfinite(value) ? value : 0.0f;
}

SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density, const Job& job) {
  SurfaceMeasure result;
  result.faces = measure_faces(rest, density, job);
  for (const FaceStatistics& face : result.faces) {
    result.area += face.area;
    result.mass += face.mass;
  }
  return result;
}

FollicleCandidates::FollicleCandidates(const LimitSurface& rest, const FollicleDensity& density,
                                       uint64_t seed, size_t wanted, SurfaceMeasure measure)
    : rest_(rest),
      density_(density),
      seed_(seed),
      room_(density.is_uniform() ? 1.0f : 1.25f),
      measure_(std::move(measure)),
      first_(measure_.faces.size() + 1, 0) {
  want(wanted);
}

void FollicleCandidates::want(size_t wanted) {
  wanted_ = wanted;
  if (!(measure_.mass > 0)) return;
  // The number of attempts per face is its area times a bound of its density.
  double cumulative = 0;
  for (size_t f = 0; f < measure_.faces.size(); ++f) {
    const FaceStatistics& face = measure_.faces[f];
    const double limit = face.largest_density * room_;
    cumulative += static_cast<double>(wanted) * face.area * limit / measure_.mass;
    if (!(cumulative < 0x1p32)) {
      throw Error(ErrorKind::kInput,
                  "the density is too uneven: more than 4 billion candidate positions would be needed; use "
                  "fewer strands or a more even density");
    }
    first_[f + 1] = static_cast<uint64_t>(cumulative);
  }
}

size_t FollicleCandidates::face_of(uint64_t attempt) const {
  return static_cast<size_t>(std::upper_bound(first_.begin(), first_.end(), attempt) - first_.begin()) - 1;
}

uint64_t FollicleCandidates::stream(size_t face, uint64_t attempt) const {
  return hash64(seed_, face, attempt - first_[face], random_use("follicle"));
}

uint64_t FollicleCandidates::order_key(uint64_t attempt) const {
  return mix64(stream(face_of(attempt), attempt));
}

/// Order of candidates with the same random number.
bool FollicleCandidates::precedes(uint64_t attempt, uint64_t other) const {
  const uint64_t a = order_key(attempt), b = order_key(other);
  return a != b ? a < b : attempt < other;
}

RootAddress FollicleCandidates::root(uint32_t attempt, V3f* position) const {
  const size_t face = face_of(attempt);
  const Place place =
      place_on_face(rest_, static_cast<uint32_t>(face), measure_.faces[face], stream(face, attempt));
  *position = place.point.position;
  return place.root;
}

template <class Visit>
void FollicleCandidates::try_all(uint64_t begin, uint64_t end, const CandidateShare& share,
                                 const Visit& visit) const {
  size_t f = face_of(begin);
  for (uint64_t i = begin; i < end; ++i) {
    while (i >= first_[f + 1]) ++f;
    const uint64_t stream = this->stream(f, i);
    const uint64_t number = mix64(stream) >> 32;
    if (number < share.begin || number >= share.end) continue;
    FollicleCandidate candidate;
    if (!try_candidate(rest_, density_, static_cast<uint32_t>(f), measure_.faces[f], room_, stream,
                       candidate))
      continue;
    candidate.attempt = static_cast<uint32_t>(i);
    candidate.number = static_cast<uint32_t>(number);
    visit(candidate);
  }
}

// Small faces are grouped and large ones divided, independent of the threads; temporary memory of the parts
// is small.
constexpr uint64_t kPart = 4096, kGroup = 64;

CandidateSurvey FollicleCandidates::survey(const Job& job) const {
  const uint64_t tries = first_.back();
  std::vector<CandidateSurvey> parts(kGroup);
  CandidateSurvey result;
  for (uint64_t group = 0; group < tries; group += kGroup * kPart) {
    const uint64_t count = std::min(kGroup, (tries - group + kPart - 1) / kPart);
    job.for_each(count, 1, [&](WorkRange range) {
      for (size_t part = range.begin; part < range.end; ++part) {
        const uint64_t begin = group + part * kPart;
        CandidateSurvey seen;
        try_all(begin, std::min(tries, begin + kPart), {},
                [&](const FollicleCandidate& candidate) { seen.add(candidate); });
        parts[part] = seen;
      }
    });
    for (size_t part = 0; part < count; ++part) {
      result.count += parts[part].count;
      result.box.extendBy(parts[part].box);
      result.smallest_spacing = std::min(result.smallest_spacing, parts[part].smallest_spacing);
    }
    job.progress.advance(static_cast<double>(std::min(kGroup * kPart, tries - group)) /
                         static_cast<double>(tries));
  }
  return result;
}

std::vector<FollicleCandidate> FollicleCandidates::make_by_attempt(const Job& job,
                                                                   const CandidateShare& share) const {
  const uint64_t tries = first_.back();
  const double part_of_all = static_cast<double>(share.end - share.begin) * 0x1p-32;
  const auto expected = static_cast<uint64_t>(part_of_all * static_cast<double>(wanted_));
  std::vector<FollicleCandidate> result;
  result.reserve(std::min<uint64_t>(tries, max_of(expected)));
  std::vector<std::vector<FollicleCandidate>> kept(kGroup);
  for (uint64_t group = 0; group < tries; group += kGroup * kPart) {
    const uint64_t parts = std::min(kGroup, (tries - group + kPart - 1) / kPart);
    job.for_each(parts, 1, [&](WorkRange range) {
      for (size_t part = range.begin; part < range.end; ++part) {
        const uint64_t begin = group + part * kPart;
        kept[part].clear();
        try_all(begin, std::min(tries, begin + kPart), share,
                [&](const FollicleCandidate& candidate) { kept[part].push_back(candidate); });
      }
    });
    for (size_t part = 0; part < parts; ++part)
      result.insert(result.end(), kept[part].begin(), kept[part].end());
    job.progress.advance(part_of_all * static_cast<double>(std::min(kGroup * kPart, tries - group)) /
                         static_cast<double>(tries));
  }
  return result;
}

std::vector<FollicleCandidate> FollicleCandidates::make(const Job& job, const CandidateShare& share) const {
  std::vector<FollicleCandidate> result = make_by_attempt(job, share);
  stoppable_sort(job, result.begin(), result.end(),
                 [&](const FollicleCandidate& a, const FollicleCandidate& b) {
                   return a.number != b.number ? a.number < b.number : precedes(a.attempt, b.attempt);
                 });
  return result;
}

std::vector<FollicleCandidate> FollicleCandidates::make_ranked(const Job& job) const {
  std::vector<FollicleCandidate> result = make_by_attempt(job, {});
  std::vector<SortItem> order(result.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = {result[i].number, i};
  sort_by_key(order, 32, job);
  for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && order[end].key == order[begin].key) ++end;
    if (end - begin == 1) continue;
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end), [&](const SortItem& a, const SortItem& b) {
                return precedes(result[a.index].attempt, result[b.index].attempt);
              });
  }
  for (uint32_t rank = 0; rank < order.size(); ++rank) result[order[rank].index].number = rank;
  return result;
}

uint32_t pack_normal(const V3f& normal) {
  const auto bits = [](float c) {
    // As std::lround(): the sum is exact.
    return static_cast<uint32_t>((std::clamp(c, -1.0f, 1.0f) * 0.5f + 0.5f) * 1023.0f + 0.5);
  };
  return bits(normal.x) | bits(normal.y) << 10 | bits(normal.z) << 20;
}

V3f unpack_normal(uint32_t packed) {
  const auto value = [](uint32_t bits) { return static_cast<float>(bits & 1023) * (2.0f / 1023.0f) - 1.0f; };
  return {value(packed), value(packed >> 10), value(packed >> 20)};
}

}  // namespace pelage
