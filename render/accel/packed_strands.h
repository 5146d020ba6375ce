// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/page_block.h"
#include "geom/strands.h"
#include "render/accel/chunk_grower.h"
#include "render/accel/segment_patterns.h"

namespace pelage {

/// Storage format of packed floats. A format is chosen only for floats that it stores without loss, so every
/// format restores exactly the floats that were packed.
enum class Precision : uint8_t {
  kFloat,
  kUnorm16,  ///< multiples of 1/65535 in [0, 1]
  kUnorm8,   ///< multiples of 1/255 in [0, 1], which are multiples of 1/65535 too
};
inline size_t precision_bytes(Precision precision) {
  return precision == Precision::kFloat ? 4 : precision == Precision::kUnorm16 ? 2 : 1;
}

/// Returns `x` rounded for packing. A value in [0, 1] is rounded to the nearest multiple of 1/65535: 0 and 1
/// stay exact, and the max error is about 2^-17. Any other value is returned unchanged. The result depends on
/// `x` alone, so the division of strands into chunks never affects a pixel.
float packed_value(float x);

/// Returns the coarsest precision that restores all `values` bit by bit. The values need not have been
/// rounded by packed_value().
Precision coarsest_precision(std::span<const float> values);

/// Writes `values` to `out`. The caller must choose a precision that restores them exactly, for example
/// coarsest_precision(). `out` must be aligned to precision_bytes(precision).
void pack_values(std::span<const float> values, Precision precision, std::byte* out);

/// Returns element `index` of the values that pack_values() wrote with the same precision.
inline float unpacked_value(const std::byte* packed, Precision precision, size_t index) {
  switch (precision) {
    case Precision::kFloat:
      return reinterpret_cast<const float*>(packed)[index];
    case Precision::kUnorm16:
      return static_cast<float>(reinterpret_cast<const uint16_t*>(packed)[index]) / 65535.0f;
    case Precision::kUnorm8:
      return static_cast<float>(257u * reinterpret_cast<const uint8_t*>(packed)[index]) / 65535.0f;
  }
  return 0;
}

/// Where the control points of packed strands are stored.
enum class PackedPoints {
  kInPlace,   ///< in the packed strands, as Embree reads them
  kInFurTree  ///< in a fur tree: strands are ordered by id, segments are numbered as in the tree
};

/// The strands of a chunk in compact form, in one block of memory. The block has the control points as Embree
/// reads them, including phantom points (additional points before the first and after the last point of a
/// strand), unless the points are stored in a fur tree. All other data is stored in the smallest form from
/// which it can be restored.
///
/// Points, radii, ids and the faces of roots are restored bit by bit. With `compact`, attributes, opacities,
/// positions of roots in their faces and texture coordinates are rounded by packed_value(), stored at the
/// lowest frequency that suffices (constant, per strand or per point), and take 1, 2 or 4 bytes per value.
/// Without `compact`, they are stored without loss. Strands without a segment are omitted. Thread safety:
/// immutable.
class PackedStrands {
 public:
  /// Packs strands together with their points (PackedPoints::kInPlace). `opacity`: one value in [0, 1] per
  /// point, or empty if all strands are opaque.
  PackedStrands(const Strands& strands, std::span<const float> opacity, bool compact,
                SegmentPatterns& patterns);
  /// Packs strands without their points, which a fur tree stores (PackedPoints::kInFurTree).
  PackedStrands(const Strands& strands, std::span<const float> opacity, bool compact);

  size_t strand_count() const { return strand_count_; }
  size_t segment_count() const { return segment_count_; }
  CurveBasis basis() const { return basis_; }
  int motion_keys() const { return motion_keys_; }
  bool opaque() const { return opaque_; }

  /// Returns x, y, z and radius of every control point at one motion key, including phantom points.
  /// vertices(), segments(), copy_strand() and fetch_ahead() may be called only when points are stored in
  /// place.
  const float* vertices(int key) const {
    return reinterpret_cast<const float*>(block_.data()) + static_cast<size_t>(key) * vertex_count_ * 4;
  }
  size_t vertex_count() const { return vertex_count_; }
  /// Index of the first control point of each segment.
  const uint32_t* segments() const { return segments_; }

  struct Place {
    uint32_t strand = 0;
    uint32_t segment = 0;
  };
  Place locate(uint32_t primitive) const {
    if (segments_per_strand_ == 0) return search(primitive);
    const uint32_t strand = primitive / segments_per_strand_;
    return {strand, primitive - strand * segments_per_strand_};
  }
  uint64_t id(uint32_t strand) const {
    return wide_ids_ ? at<uint64_t>(ids_)[strand] : first_id_ + at<uint32_t>(ids_)[strand];
  }
  float opacity(Place place, float u) const;
  /// Copies a strand to `out`, replacing the contents of `out` but reusing its memory.
  void copy_strand(uint32_t strand, Strands& out) const;
  uint32_t first_segment(uint32_t strand) const {
    return segments_per_strand_ != 0 ? strand * segments_per_strand_ : at<uint32_t>(first_segments_)[strand];
  }
  uint32_t strand_segments(uint32_t strand) const {
    return first_segment(strand + 1) - first_segment(strand);
  }
  /// Returns a strand as Bezier curves. Its points are allocated but not written; the caller must write them.
  /// Reuses the allocations of `memory`.
  StrandArrays bezier_strand(uint32_t strand, StrandArrays memory) const;
  /// The two parts of the serialised strands: stored_head() returns all data except the block, and
  /// stored_block() returns the block. The points must be stored in a fur tree.
  std::vector<std::byte> stored_head() const;
  std::span<const std::byte> stored_block() const { return {block_.data(), block_.bytes()}; }
  /// Restores strands from both parts. Returns nothing if the parts are inconsistent.
  static std::optional<PackedStrands> from_stored(std::span<const std::byte> head, PageBlock block);

  /// Prefetches the first data that copy_strand() will read.
  void fetch_ahead(uint32_t primitive) const;

  /// Bytes of memory in use, including this object.
  size_t bytes() const;
  /// Upper bound of bytes() for any batch with these counts.
  static size_t bytes_bound(const ChunkCounts& counts, PackedPoints points = PackedPoints::kInPlace);
  /// Upper bound of the temporary memory, in bytes, while strands with these counts are packed.
  static size_t scratch_bytes_bound(const ChunkCounts& counts);

 private:
  struct Values {
    size_t offset = 0;
    Precision precision = Precision::kFloat;
    AttributeClass frequency = AttributeClass::kConstant;
    uint32_t components = 1;
  };
  struct Attribute {
    std::string name;
    Values values;
  };
  class Packer;

  PackedStrands() = default;
  template <class Packed, class Use>
  static void for_each_number(Packed& packed, const Use& use);
  /// Whether all reads stay within the block.
  bool is_possible() const;

  template <class T>
  const T* at(size_t offset) const {
    return reinterpret_cast<const T*>(block_.data() + offset);
  }
  Place search(uint32_t primitive) const;
  struct PointRange {
    size_t first;
    uint32_t count, stride;
  };
  /// Copies everything of a strand except basis and points. `range`: which per-point values are needed, and
  /// their destination in `out`.
  void copy_rest(uint32_t strand, const PointRange& range, StrandArrays& out) const;
  /// Count of a strand's original points (without phantom points), and the index of the first of them.
  uint32_t strand_points(uint32_t strand) const;
  size_t first_point(uint32_t strand) const;
  float value(const Values& values, size_t index) const {
    return unpacked_value(block_.data() + values.offset, values.precision, index);
  }

  PageBlock block_;
  std::shared_ptr<const SegmentPatterns::Pattern> pattern_;
  const uint32_t* segments_ = nullptr;
  size_t strand_count_ = 0, segment_count_ = 0, vertex_count_ = 0;
  uint64_t first_id_ = 0;
  size_t ids_ = 0, faces_ = 0, first_segments_ = 0;
  uint32_t segments_per_strand_ = 0;  // if all strands have the same number; otherwise 0
  uint32_t extra_ = 3;                // control points minus segments, per strand
  uint32_t phantoms_ = 0;             // phantom points per strand
  uint32_t first_face_ = 0;
  int motion_keys_ = 1;
  CurveBasis basis_ = CurveBasis::kPinnedBSpline;
  bool opaque_ = true, wide_ids_ = false, has_roots_ = false, wide_faces_ = false, has_root_uv_ = false;
  Values root_place_, root_uv_, opacity_;
  std::vector<Attribute> attributes_;
};

}  // namespace pelage
