// SPDX-License-Identifier: Apache-2.0
// Packs strands; packed_strands.cpp reads them.
#include <algorithm>
#include <bit>
#include <limits>

#include "base/check.h"
#include "render/accel/packed_strands.h"

namespace pelage {
namespace {

constexpr size_t kAlignment = 16;  // of every array in the block

bool same(const float* a, const float* b, size_t count) {
  return std::equal(a, a + count, b, [](float x, float y) {
    return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
  });
}

}  // namespace

/// Fills a PackedStrands: first all data is converted to its final frequency and precision and gets a
/// position, then the block is allocated and written.
class PackedStrands::Packer {
 public:
  /// Points are stored here if there are `patterns`.
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
    std::memset(out_.block_.data(), 0,
                out_.block_.bytes());  // including gaps, because it may be written to a file
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
    uint64_t min = std::numeric_limits<uint64_t>::max(), max = 0;
    for (uint32_t s : kept_) {
      min = std::min(min, strands_.id(s));
      max = std::max(max, strands_.id(s));
    }
    out_.wide_ids_ = !kept_.empty() && max - min > std::numeric_limits<uint32_t>::max();
    out_.first_id_ = min;
    out_.ids_ = place((out_.wide_ids_ ? sizeof(uint64_t) : sizeof(uint32_t)) * kept_.size());
  }

  void plan_roots() {
    out_.has_roots_ = strands_.has_roots();
    out_.has_root_uv_ = !strands_.arrays().root_uv.empty();
    if (out_.has_roots_) {
      uint32_t min = std::numeric_limits<uint32_t>::max(), max = 0;
      std::vector<float> uv;
      uv.reserve(2 * kept_.size());
      for (uint32_t s : kept_) {
        const RootAddress& root = strands_.root(s);
        min = std::min(min, root.face);
        max = std::max(max, root.face);
        uv.push_back(root.u);
        uv.push_back(root.v);
      }
      out_.wide_faces_ = !kept_.empty() && max - min > std::numeric_limits<uint16_t>::max();
      out_.first_face_ = min;
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
    // Reserved first: planned_ keeps pointers into it.
    out_.attributes_.reserve(strands_.attributes().size());
    for (const StrandAttribute& attribute : strands_.attributes()) {
      const auto components = static_cast<uint32_t>(attribute.components);
      out_.attributes_.push_back({attribute.name, {}});
      plan(out_.attributes_.back().values, gathered(attribute.values.data(), attribute.frequency, components),
           attribute.frequency, components);
    }
  }

  /// The values of the kept strands.
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

  /// Converts per point to per strand when every strand has a single value along it.
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

  /// Converts per strand to constant when all strands have the same value.
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

}  // namespace pelage
