// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: contents of blocks of four segments.

/// Motion of a tree. kAny: known at run time only; slower, with the same bits.
enum class Motion { kNone, kKeys, kAny };

/// The four curves of a block: Bezier points by axis, radii.
template <bool kWide, Motion kMotion>
class Block {
 public:
  PELAGE_FUR_INLINE Block(const std::byte* block, const FurRay& ray, int motion_keys)
      : key_(block + sizeof(FurBlockHeader) + static_cast<size_t>(ray.key) * kSizes.key()),
        next_(motion_keys > 1 ? kSizes.key() : 0),
        before_(1 - ray.fraction),
        after_(ray.fraction) {
    for (size_t axis = 0; axis < 3; ++axis)
      origin_[axis] = static_cast<float>(reinterpret_cast<const FurBlockHeader*>(block)->origin[axis]);
  }

  /// Coordinates of one Bezier point, from `lane` on, exact except for rounding of motion.
  PELAGE_FUR_INLINE hn::Vec<Doubles> coordinates(uint32_t axis, size_t point, size_t lane) const {
    const std::byte* place = key_ + axis * kSizes.axis + (4 * point + lane) * (kSizes.axis / 16);
    const auto here = decoded(place, axis);
    if constexpr (!kMoving) return here;
    const double after = after_;
    return hn::Add(hn::Mul(here, hn::Set(kDoubles, 1 - after)),
                   hn::Mul(decoded(place + next(), axis), hn::Set(kDoubles, after)));
  }
  /// Numbers of the axis from `first` on, all lanes of a point and then those of the next: coordinates of the
  /// first point, followed by the differences of each point from the previous one.
  template <class D>
  PELAGE_FUR_INLINE hn::Vec<D> differences(D d, uint32_t axis, size_t first) const {
    const std::byte* place = key_ + axis * kSizes.axis + first * (kSizes.axis / 16);
    const auto here = decoded_difference(d, place, axis, first);
    if constexpr (!kMoving) return here;
    return mix(d, here, decoded_difference(d, place + next(), axis, first));
  }
  PELAGE_FUR_INLINE void load_radii(V (&r)[4]) const {
    for (size_t i = 0; i < 4; ++i) {
      const std::byte* place = key_ + 3 * kSizes.axis + i * (kSizes.radii / 4);
      r[i] = radius(place);
      if constexpr (kMoving) r[i] = mix(kFloats, r[i], radius(place + next()));
    }
  }
  PELAGE_FUR_INLINE V max_radius() const {
    if constexpr (kWide || kMoving) {
      V r[4];
      load_radii(r);
      return hn::Max(hn::Max(r[0], r[1]), hn::Max(r[2], r[3]));
    } else {
      const hn::Full128<uint8_t> bytes;
      auto max = hn::Load(bytes, reinterpret_cast<const uint8_t*>(key_ + 3 * kSizes.axis));
      max = hn::Max(max, hn::ShiftRightBytes<8>(bytes, max));
      max = hn::Max(max, hn::ShiftRightBytes<4>(bytes, max));
      return square_of(hn::ConvertTo(kFloats, hn::PromoteTo(kInts, hn::LowerHalf(hn::LowerHalf(max)))));
    }
  }

 private:
  static constexpr FurBlockSizes kSizes = kWide ? kWideBlock : kNarrowBlock;
  static constexpr bool kMoving = kMotion != Motion::kNone;

  /// From one key to the next.
  PELAGE_FUR_INLINE size_t next() const { return kMotion == Motion::kKeys ? kSizes.key() : next_; }

  static PELAGE_FUR_INLINE V square_of(V root) { return hn::Mul(hn::Mul(root, root), all(1.0f / 256)); }
  template <class D>
  PELAGE_FUR_INLINE hn::Vec<D> mix(D d, hn::Vec<D> a, hn::Vec<D> b) const {
    return hn::Add(hn::Mul(a, hn::Set(d, before_)), hn::Mul(b, hn::Set(d, after_)));
  }
  PELAGE_FUR_INLINE hn::Vec<Doubles> decoded(const std::byte* place, uint32_t axis) const {
    if constexpr (kWide) {
      const hn::Rebind<float, Doubles> floats;
      return hn::PromoteTo(kDoubles, hn::LoadU(floats, reinterpret_cast<const float*>(place)));
    } else {
      const hn::Rebind<uint16_t, Doubles> words;
      const hn::Rebind<int32_t, Doubles> ints;
      const auto difference = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(place)));
      return hn::Add(hn::PromoteTo(kDoubles, difference), hn::Set(kDoubles, origin_[axis]));
    }
  }
  /// The values before the first point are read but not used.
  template <class D>
  PELAGE_FUR_INLINE hn::Vec<D> decoded_difference(D d, const std::byte* place, uint32_t axis,
                                                  size_t first) const {
    const std::byte* before = place - kSizes.axis / 4;
    if constexpr (kWide) {
      const auto points = hn::LoadU(d, reinterpret_cast<const float*>(place));
      return hn::Sub(points,
                     without_first_point(d, first, hn::LoadU(d, reinterpret_cast<const float*>(before))));
    } else {
      const hn::Rebind<uint16_t, D> words;
      const hn::Rebind<int32_t, D> ints;
      const auto points = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(place)));
      const auto last = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(before)));
      const auto difference = hn::ConvertTo(d, hn::Sub(points, without_first_point(ints, first, last)));
      return hn::Add(difference, of_first_point(d, first, hn::Set(d, origin_[axis])));
    }
  }
  PELAGE_FUR_INLINE V radius(const std::byte* place) const {
    if constexpr (kWide) {
      return hn::Load(kFloats, reinterpret_cast<const float*>(place));
    } else {
      return square_of(bytes_at(place));
    }
  }

  const std::byte* key_;
  size_t next_;
  float origin_[3];
  float before_, after_;
};
