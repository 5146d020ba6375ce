// SPDX-License-Identifier: Apache-2.0
#include "render/accel/packed_strands.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "base/check.h"

namespace pelage {
namespace {

constexpr size_t kAlignment = 16;                              // of every array in the block
constexpr size_t kArrays = 12;                                 // beside the attributes
constexpr size_t kMostAttributes = 16, kAttributeBytes = 256;  // generous, for bytes_bound()

bool same(const float* a, const float* b, size_t count) {
  return std::equal(a, a + count, b, [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

}  // namespace

/// Fills a PackedStrands: first everything is brought into its final class and precision and given a place,
/// then the block is made and written.
class PackedStrands::Packer {
 public:
  /// Points are kept here when there are `patterns`.
  Packer(PackedStrands& out, const Strands& strands, bool compact, SegmentPatterns* patterns)
      : out_(out), strands_(strands), compact_(compact), patterns_(patterns) {
    PELAGE_CHECK(strands.basis() != CurveBasis::kBezier);
    kept_.reserve(strands.strand_count());
    for (uint32_t s = 0; s < strands.strand_count(); ++s) {
      if (segments_of(s) > 0) kept_.push_back(s);
    }
    if (patterns_) return;
    std::stable_sort(kept_.begin(), kept_.end(),
                     [&](uint32_t a, uint32_t b) { return strands.id(a) < strands.id(b); });
  }

  void pack(std::span<const float> opacity) {
    out_.basis_ = strands_.basis();
    out_.motion_keys_ = strands_.motion_keys();
    out_.extra_ = strands_.basis() == CurveBasis::kLinear ? 1 : 3;
    out_.phantoms_ =
        strands_.basis() == CurveBasis::kPinnedBSpline || strands_.basis() == CurveBasis::kCatmullRom ? 2 : 0;
    count();
    if (patterns_) place(sizeof(float) * 4 * out_.vertex_count_ * static_cast<size_t>(out_.motion_keys_));
    plan_segments();
    plan_ids();
    plan_roots();
    plan_values(opacity);
    out_.block_ = PageBlock(size_);
    std::memset(out_.block_.data(), 0, out_.block_.bytes());  // gaps too: it may go into a file
    if (patterns_) write_points();
    write_segments();
    write_ids();
    write_roots();
    for (const Planned& planned : planned_) {
      pack_values(planned.numbers, planned.values->precision, out_.block_.data() + planned.values->offset);
    }
  }

 private:
  struct Planned {
    Values* values;
    std::vector<float> numbers;
  };

  uint32_t segments_of(uint32_t s) const {
    return pelage::segment_count(strands_.basis(), strands_.strand_points(s));
  }
  size_t place(size_t bytes) {
    const size_t at = size_;
    size_ += (bytes + kAlignment - 1) / kAlignment * kAlignment;
    return at;
  }
  template <class T>
  T* array(size_t offset) {
    return reinterpret_cast<T*>(out_.block_.data() + offset);
  }

  void count() {
    out_.strand_count_ = kept_.size();
    bool uniform = !kept_.empty();
    for (uint32_t s : kept_) {
      out_.segment_count_ += segments_of(s);
      uniform &= segments_of(s) == segments_of(kept_.front());
    }
    out_.vertex_count_ = out_.segment_count_ + out_.extra_ * kept_.size();
    PELAGE_CHECK(out_.vertex_count_ <= std::numeric_limits<uint32_t>::max());
    if (uniform) out_.segments_per_strand_ = segments_of(kept_.front());
  }

  void plan_segments() {
    if (out_.segments_per_strand_ != 0) {
      if (patterns_)
        out_.pattern_ = patterns_->get(out_.segments_per_strand_, out_.segments_per_strand_ + out_.extra_,
                                       out_.strand_count_);
      return;
    }
    out_.first_segments_ = place(sizeof(uint32_t) * (kept_.size() + 1));
    if (patterns_) own_segments_ = place(sizeof(uint32_t) * out_.segment_count_);
  }

  void plan_ids() {
    uint64_t least = std::numeric_limits<uint64_t>::max(), most = 0;
    for (uint32_t s : kept_) {
      least = std::min(least, strands_.id(s));
      most = std::max(most, strands_.id(s));
    }
    out_.wide_ids_ = !kept_.empty() && most - least > std::numeric_limits<uint32_t>::max();
    out_.first_id_ = least;
    out_.ids_ = place((out_.wide_ids_ ? sizeof(uint64_t) : sizeof(uint32_t)) * kept_.size());
  }

  void plan_roots() {
    out_.has_roots_ = strands_.has_roots();
    out_.has_root_uv_ = !strands_.arrays().root_uv.empty();
    if (out_.has_roots_) {
      uint32_t least = std::numeric_limits<uint32_t>::max(), most = 0;
      std::vector<float> uv;
      uv.reserve(2 * kept_.size());
      for (uint32_t s : kept_) {
        const RootAddress& root = strands_.root(s);
        least = std::min(least, root.face);
        most = std::max(most, root.face);
        uv.push_back(root.u);
        uv.push_back(root.v);
      }
      out_.wide_faces_ = !kept_.empty() && most - least > std::numeric_limits<uint16_t>::max();
      out_.first_face_ = least;
      out_.faces_ = place((out_.wide_faces_ ? sizeof(uint32_t) : sizeof(uint16_t)) * kept_.size());
      plan(out_.root_place_, std::move(uv), AttributeClass::kPerStrand, 2);
    }
    if (out_.has_root_uv_) {
      std::vector<float> uv;
      uv.reserve(2 * kept_.size());
      for (uint32_t s : kept_) uv.insert(uv.end(), {strands_.root_uv(s).x, strands_.root_uv(s).y});
      plan(out_.root_uv_, std::move(uv), AttributeClass::kPerStrand, 2);
    }
  }

  void plan_values(std::span<const float> opacity) {
    if (!opacity.empty()) {
      PELAGE_CHECK(opacity.size() == strands_.point_count());
      plan(out_.opacity_, gathered(opacity.data(), AttributeClass::kPerPoint, 1), AttributeClass::kPerPoint,
           1);
      const Values& o = out_.opacity_;
      out_.opaque_ = o.frequency == AttributeClass::kConstant && planned_.back().numbers[0] >= 1;
    }
    // Reserved first: what is planned points into it.
    out_.attributes_.reserve(strands_.attributes().size());
    for (const StrandAttribute& attribute : strands_.attributes()) {
      const auto components = static_cast<uint32_t>(attribute.components);
      out_.attributes_.push_back({attribute.name, {}});
      plan(out_.attributes_.back().values, gathered(attribute.values.data(), attribute.frequency, components),
           attribute.frequency, components);
    }
  }

  /// Those of the kept strands.
  std::vector<float> gathered(const float* from, AttributeClass frequency, uint32_t components) const {
    if (frequency == AttributeClass::kConstant) return {from, from + components};
    std::vector<float> numbers;
    numbers.reserve(components * (frequency == AttributeClass::kPerPoint
                                      ? out_.segment_count_ + point_excess() * kept_.size()
                                      : kept_.size()));
    for (uint32_t s : kept_) {
      const bool per_point = frequency == AttributeClass::kPerPoint;
      const size_t begin = per_point ? strands_.first_point(s) : s;
      const size_t count = per_point ? strands_.strand_points(s) : 1;
      numbers.insert(numbers.end(), from + begin * components, from + (begin + count) * components);
    }
    return numbers;
  }
  uint32_t point_excess() const { return out_.extra_ - out_.phantoms_; }

  void plan(Values& values, std::vector<float> numbers, AttributeClass frequency, uint32_t components) {
    values.components = components;
    values.frequency = frequency;
    if (compact_) {
      for (float& x : numbers) x = packed_value(x);
      if (values.frequency == AttributeClass::kPerPoint) thin_strands(values, numbers);
      if (values.frequency == AttributeClass::kPerStrand) thin_batch(values, numbers);
      values.precision = coarsest_precision(numbers);
    }
    values.offset = place(numbers.size() * precision_bytes(values.precision));
    planned_.push_back({&values, std::move(numbers)});
  }

  /// Per point becomes per strand where every strand has one value along it.
  void thin_strands(Values& values, std::vector<float>& numbers) const {
    const size_t n = values.components;
    const float* first = numbers.data();
    for (uint32_t s : kept_) {
      const uint32_t points = strands_.strand_points(s);
      for (uint32_t i = 1; i < points; ++i) {
        if (!same(first, first + i * n, n)) return;
      }
      first += points * n;
    }
    size_t from = 0, to = 0;
    for (uint32_t s : kept_) {
      std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(from), n,
                  numbers.begin() + static_cast<std::ptrdiff_t>(to));
      from += strands_.strand_points(s) * n;
      to += n;
    }
    numbers.resize(to);
    values.frequency = AttributeClass::kPerStrand;
  }

  /// Per strand becomes constant where all strands have one value.
  void thin_batch(Values& values, std::vector<float>& numbers) const {
    const size_t n = values.components;
    if (numbers.empty()) return;
    for (size_t i = n; i < numbers.size(); i += n) {
      if (!same(numbers.data(), &numbers[i], n)) return;
    }
    numbers.resize(n);
    values.frequency = AttributeClass::kConstant;
  }

  void write_points() {
    float* out = array<float>(0);
    const bool phantoms = out_.phantoms_ > 0;
    for (int key = 0; key < out_.motion_keys_; ++key) {
      const float* points = strands_.points(key).data();
      for (uint32_t s : kept_) {
        const uint32_t n = strands_.strand_points(s);
        const float* p = points + size_t(4) * strands_.first_point(s);
        const float* last = p + size_t(4) * (n - 1);
        if (phantoms) {
          for (int c = 0; c < 4; ++c) *out++ = 2 * p[c] - p[4 + c];
        }
        out = std::copy_n(p, size_t(4) * n, out);
        if (phantoms) {
          for (int c = 0; c < 4; ++c) *out++ = 2 * last[c] - last[c - 4];
        }
      }
    }
  }

  void write_segments() {
    if (out_.segments_per_strand_ != 0) {
      if (out_.pattern_) out_.segments_ = out_.pattern_->first_vertex.data();
      return;
    }
    auto* first_segment = array<uint32_t>(out_.first_segments_);
    uint32_t segments = 0;
    for (uint32_t s : kept_) {
      *first_segment++ = segments;
      segments += segments_of(s);
    }
    *first_segment = segments;
    if (!patterns_) return;
    auto* segment = array<uint32_t>(own_segments_);
    uint32_t vertex = 0;
    for (uint32_t s : kept_) {
      for (uint32_t i = 0; i < segments_of(s); ++i) *segment++ = vertex + i;
      vertex += segments_of(s) + out_.extra_;
    }
    out_.segments_ = array<uint32_t>(own_segments_);
  }

  void write_ids() {
    for (size_t i = 0; i < kept_.size(); ++i) {
      const uint64_t id = strands_.id(kept_[i]);
      if (out_.wide_ids_) {
        array<uint64_t>(out_.ids_)[i] = id;
      } else {
        array<uint32_t>(out_.ids_)[i] = static_cast<uint32_t>(id - out_.first_id_);
      }
    }
  }

  void write_roots() {
    if (!out_.has_roots_) return;
    for (size_t i = 0; i < kept_.size(); ++i) {
      const uint32_t face = strands_.root(kept_[i]).face - out_.first_face_;
      if (out_.wide_faces_) {
        array<uint32_t>(out_.faces_)[i] = face;
      } else {
        array<uint16_t>(out_.faces_)[i] = static_cast<uint16_t>(face);
      }
    }
  }

  PackedStrands& out_;
  const Strands& strands_;
  const bool compact_;
  SegmentPatterns* const patterns_;
  std::vector<uint32_t> kept_;
  std::vector<Planned> planned_;
  size_t size_ = 0;
  size_t own_segments_ = 0;
};

PackedStrands::PackedStrands(const Strands& strands, std::span<const float> opacity, bool compact,
                             SegmentPatterns& patterns) {
  Packer(*this, strands, compact, &patterns).pack(opacity);
}

PackedStrands::PackedStrands(const Strands& strands, std::span<const float> opacity, bool compact) {
  Packer(*this, strands, compact, nullptr).pack(opacity);
}

PackedStrands::Place PackedStrands::search(uint32_t primitive) const {
  const auto* begin = at<uint32_t>(first_segments_);
  const auto* above = std::upper_bound(begin, begin + strand_count_, primitive);
  const auto strand = static_cast<uint32_t>(above - begin - 1);
  return {strand, primitive - begin[strand]};
}

uint32_t PackedStrands::strand_points(uint32_t strand) const {
  return strand_segments(strand) + extra_ - phantoms_;
}

size_t PackedStrands::first_point(uint32_t strand) const {
  return first_segment(strand) + static_cast<size_t>(extra_ - phantoms_) * strand;
}

float PackedStrands::opacity(Place place, float u) const {
  if (opaque_) return 1;
  if (opacity_.frequency == AttributeClass::kConstant) return value(opacity_, 0);
  if (opacity_.frequency == AttributeClass::kPerStrand) return value(opacity_, place.strand);
  // A span of an unpinned B-spline lies beside its second and third points.
  const size_t before = basis_ == CurveBasis::kBSpline ? 1 : 0;
  const size_t index = first_point(place.strand) + place.segment + before;
  return interpolate(value(opacity_, index), value(opacity_, index + 1), u);
}

void PackedStrands::copy_strand(uint32_t strand, Strands& out) const {
  StrandArrays a = std::move(out).release();
  const uint32_t count = strand_points(strand);
  const size_t first_vertex = first_segment(strand) + static_cast<size_t>(extra_) * strand + phantoms_ / 2;
  a.basis = basis_;
  a.points.clear();
  for (int key = 0; key < motion_keys_; ++key) {
    const float* points = vertices(key) + 4 * first_vertex;
    a.points.insert(a.points.end(), points, points + size_t(4) * count);
  }
  copy_rest(strand, {first_point(strand), count, 1}, a);
  out = Strands(std::move(a));
}

StrandArrays PackedStrands::bezier_strand(uint32_t strand, StrandArrays a) const {
  const uint32_t segments = strand_segments(strand);
  // A span of an unpinned B-spline lies beside its second and third points.
  const size_t before = basis_ == CurveBasis::kBSpline ? 1 : 0;
  a.basis = CurveBasis::kBezier;
  a.points.resize(static_cast<size_t>(motion_keys_) * 4 * (3 * segments + 1));
  copy_rest(strand, {first_point(strand) + before, segments + 1, 3}, a);
  return a;
}

void PackedStrands::copy_rest(uint32_t strand, const PointRange& range, StrandArrays& a) const {
  const uint32_t points = range.stride * (range.count - 1) + 1;
  a.motion_keys = motion_keys_;
  a.first_point.assign({0, points});
  a.ids.assign({id(strand)});
  a.roots.clear();
  a.root_uv.clear();
  const size_t pair = size_t(2) * strand;
  const auto both = [&](const Values& values) {
    const size_t i = values.frequency == AttributeClass::kConstant ? 0 : pair;
    return V2f(value(values, i), value(values, i + 1));
  };
  if (has_roots_) {
    const uint32_t face = wide_faces_ ? at<uint32_t>(faces_)[strand] : at<uint16_t>(faces_)[strand];
    const V2f uv = both(root_place_);
    a.roots.push_back({first_face_ + face, uv.x, uv.y});
  }
  if (has_root_uv_) a.root_uv.push_back(both(root_uv_));

  a.attributes.resize(attributes_.size());
  for (size_t i = 0; i < attributes_.size(); ++i) {
    const Values& values = attributes_[i].values;
    StrandAttribute& attribute = a.attributes[i];
    const size_t n = values.components;
    attribute.name = attributes_[i].name;
    attribute.frequency = values.frequency;
    attribute.components = static_cast<int>(n);
    if (values.frequency != AttributeClass::kPerPoint) {
      const size_t begin = values.frequency == AttributeClass::kConstant ? 0 : strand * n;
      attribute.values.resize(n);
      for (size_t k = 0; k < n; ++k) attribute.values[k] = value(values, begin + k);
      continue;
    }
    attribute.values.resize(n * points);
    for (size_t p = 0; p < range.count; ++p) {
      float* out = &attribute.values[p * range.stride * n];
      for (size_t k = 0; k < n; ++k) out[k] = value(values, (range.first + p) * n + k);
    }
  }
}

void PackedStrands::fetch_ahead(uint32_t primitive) const {
#if defined(__GNUC__)
  if (segments_per_strand_ == 0) return;
  const uint32_t strand = primitive / segments_per_strand_;
  const size_t stride = segments_per_strand_ + extra_;
  const float* points = vertices(0) + 4 * stride * strand;
  for (uint32_t i = 0; i < stride; i += 4) __builtin_prefetch(points + size_t(4) * i);
  __builtin_prefetch(points + 4 * (stride - 1));
  __builtin_prefetch(wide_ids_ ? static_cast<const void*>(at<uint64_t>(ids_) + strand)
                               : static_cast<const void*>(at<uint32_t>(ids_) + strand));
#endif
}

size_t PackedStrands::bytes() const {
  size_t total = sizeof(*this) + block_.bytes() + attributes_.capacity() * sizeof(Attribute);
  for (const Attribute& attribute : attributes_) {
    if (attribute.name.capacity() > std::string().capacity()) total += attribute.name.capacity() + 1;
  }
  return total;
}

namespace {

/// Of attributes, opacities and roots.
size_t numbers_bound(const ChunkCounts& n) { return n.attribute_floats + n.points + 4 * n.strands; }

}  // namespace

size_t PackedStrands::bytes_bound(const ChunkCounts& n, PackedPoints points) {
  const auto keys = static_cast<size_t>(n.motion_keys);
  const size_t vertices = 16 * keys * (n.points + 2 * n.strands) + sizeof(uint32_t) * n.segments;
  const size_t block = (points == PackedPoints::kHere ? vertices : 0) +
                       n.strands * (sizeof(uint64_t) + sizeof(uint32_t)) +
                       sizeof(uint32_t) * (n.strands + 1) + sizeof(float) * numbers_bound(n);
  // Per attribute: its name and places, the end of its array.
  const size_t named = kAttributeBytes * (kArrays + std::min(n.attribute_floats, kMostAttributes));
  return sizeof(PackedStrands) + PageBlock::held_bytes(block) + named;
}

size_t PackedStrands::scratch_bytes_bound(const ChunkCounts& n) {
  return sizeof(float) * numbers_bound(n) + sizeof(uint32_t) * 2 * n.strands;
}

}  // namespace pelage
