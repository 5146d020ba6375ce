// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: blocks of four segments against a ray.

/// The four curves of a block: Bezier points by axis, radii.
template <bool kWide, bool kMoving>
class Block {
 public:
  HWY_INLINE Block(const std::byte* block, const FurRay& ray)
      : key_(block + sizeof(FurBlockHeader) + static_cast<size_t>(ray.key) * kSizes.key()),
        before_(1 - ray.fraction),
        after_(ray.fraction) {
    for (size_t axis = 0; axis < 3; ++axis)
      origin_[axis] = static_cast<float>(reinterpret_cast<const FurBlockHeader*>(block)->origin[axis]);
  }

  /// Coordinates from number `first` of the axis on: all lanes of a point, then those of the next.
  template <class D>
  HWY_INLINE hn::Vec<D> coordinates(D d, uint32_t axis, size_t first) const {
    const std::byte* place = key_ + axis * kSizes.axis + first * (kSizes.axis / 16);
    const auto here = decoded(d, place, axis);
    if constexpr (!kMoving) return here;
    return mix(d, here, decoded(d, place + kSizes.key(), axis));
  }
  /// The same where numbers are those of the first point, and behind it the differences of each point from
  /// the one before.
  template <class D>
  HWY_INLINE hn::Vec<D> differences(D d, uint32_t axis, size_t first) const {
    const std::byte* place = key_ + axis * kSizes.axis + first * (kSizes.axis / 16);
    const auto here = decoded_difference(d, place, axis, first);
    if constexpr (!kMoving) return here;
    return mix(d, here, decoded_difference(d, place + kSizes.key(), axis, first));
  }
  HWY_INLINE void load_radii(V (&r)[4]) const {
    for (size_t i = 0; i < 4; ++i) {
      const std::byte* place = key_ + 3 * kSizes.axis + i * (kSizes.radii / 4);
      r[i] = radius(place);
      if constexpr (kMoving) r[i] = mix(kFloats, r[i], radius(place + kSizes.key()));
    }
  }
  HWY_INLINE V most_radius() const {
    if constexpr (kWide || kMoving) {
      V r[4];
      load_radii(r);
      return hn::Max(hn::Max(r[0], r[1]), hn::Max(r[2], r[3]));
    } else {
      const hn::Full128<uint8_t> bytes;
      auto most = hn::Load(bytes, reinterpret_cast<const uint8_t*>(key_ + 3 * kSizes.axis));
      most = hn::Max(most, hn::ShiftRightBytes<8>(bytes, most));
      most = hn::Max(most, hn::ShiftRightBytes<4>(bytes, most));
      return square_of(hn::ConvertTo(kFloats, hn::PromoteTo(kInts, hn::LowerHalf(hn::LowerHalf(most)))));
    }
  }

 private:
  static constexpr FurBlockSizes kSizes = kWide ? kWideBlock : kNarrowBlock;

  static HWY_INLINE V square_of(V root) { return hn::Mul(hn::Mul(root, root), all(1.0f / 256)); }
  template <class D>
  HWY_INLINE hn::Vec<D> mix(D d, hn::Vec<D> a, hn::Vec<D> b) const {
    return hn::Add(hn::Mul(a, hn::Set(d, before_)), hn::Mul(b, hn::Set(d, after_)));
  }
  template <class D>
  HWY_INLINE hn::Vec<D> decoded(D d, const std::byte* place, uint32_t axis) const {
    if constexpr (kWide) {
      return hn::LoadU(d, reinterpret_cast<const float*>(place));
    } else {
      const hn::Rebind<uint16_t, D> words;
      const hn::Rebind<int32_t, D> ints;
      const auto difference = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(place)));
      return hn::Add(hn::ConvertTo(d, difference), hn::Set(d, origin_[axis]));
    }
  }
  /// What comes before the first point is read, and not used.
  template <class D>
  HWY_INLINE hn::Vec<D> decoded_difference(D d, const std::byte* place, uint32_t axis, size_t first) const {
    const std::byte* before = place - kSizes.axis / 4;
    if constexpr (kWide) {
      const auto points = hn::LoadU(d, reinterpret_cast<const float*>(place));
      return hn::Sub(points, but_first_point(d, first, hn::LoadU(d, reinterpret_cast<const float*>(before))));
    } else {
      const hn::Rebind<uint16_t, D> words;
      const hn::Rebind<int32_t, D> ints;
      const auto points = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(place)));
      const auto last = hn::PromoteTo(ints, hn::LoadU(words, reinterpret_cast<const uint16_t*>(before)));
      const auto difference = hn::ConvertTo(d, hn::Sub(points, but_first_point(ints, first, last)));
      return hn::Add(difference, of_first_point(d, first, hn::Set(d, origin_[axis])));
    }
  }
  HWY_INLINE V radius(const std::byte* place) const {
    if constexpr (kWide) {
      return hn::Load(kFloats, reinterpret_cast<const float*>(place));
    } else {
      return square_of(bytes_at(place));
    }
  }

  const std::byte* key_;
  float origin_[3];
  float before_, after_;
};

/// The first points of a block as the ray sees them, and the differences of the others.
template <class Curves>
HWY_INLINE void flatten(const Curves& curves, const FurRay& ray, FlatCurves& flat) {
  alignas(64) float xs[16], ys[16];
  const auto set = [](float value) HWY_ATTR { return hn::Set(kMany, value); };
  for (size_t i = 0; i < 16; i += hn::MaxLanes(kMany)) {
    const auto pi = curves.differences(kMany, ray.axis[0], i);
    const auto pj = curves.differences(kMany, ray.axis[1], i);
    const auto pk = curves.differences(kMany, ray.axis[2], i);
    const auto wide_x = hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pi), hn::Mul(set(ray.along_i), pk)),
                                of_first_point(kMany, i, set(ray.origin_x)));
    const auto wide_y = hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pj), hn::Mul(set(ray.along_j), pk)),
                                of_first_point(kMany, i, set(ray.origin_y)));
    hn::Store(hn::Mul(wide_x, set(ray.scale_x)), kMany, xs + i);
    hn::Store(hn::Sub(hn::Mul(wide_y, set(ray.scale_y)), hn::Mul(wide_x, set(ray.shear_y))), kMany, ys + i);
  }
  flat.x[0] = hn::Load(kFloats, xs);
  flat.y[0] = hn::Load(kFloats, ys);
  for (size_t i = 0; i < 3; ++i) {
    flat.dx[i] = hn::Load(kFloats, xs + 4 * (i + 1));
    flat.dy[i] = hn::Load(kFloats, ys + 4 * (i + 1));
  }
}

/// The last points, as those of the segments behind them come out of flatten().
template <class Curves>
HWY_INLINE void flatten_ends(const Curves& curves, const FurRay& ray, V& x, V& y) {
  const V pi = curves.coordinates(kFloats, ray.axis[0], 12),
          pj = curves.coordinates(kFloats, ray.axis[1], 12),
          pk = curves.coordinates(kFloats, ray.axis[2], 12);
  x = hn::Sub(hn::Sub(hn::Mul(all(ray.along_k), pi), hn::Mul(all(ray.along_i), pk)), all(ray.origin_x));
  y = hn::Sub(hn::Sub(hn::Mul(all(ray.along_k), pj), hn::Mul(all(ray.along_j), pk)), all(ray.origin_y));
  y = hn::Sub(hn::Mul(y, all(ray.scale_y)), hn::Mul(x, all(ray.shear_y)));
  x = hn::Mul(x, all(ray.scale_x));
}

/// The curves of one block against the ray. True when nothing more need be known of this ray.
template <bool kWide, bool kMoving, class Query>
HWY_INLINE bool test_block(const std::byte* block, const FurRay& ray, Query& query) {
  const Block<kWide, kMoving> curves(block, ray);
  FlatCurves flat;
  flatten(curves, ray, flat);

  // The curve lies within a strip along its chord: a cubic strays from the chord by at most 3/4 of what its
  // inner points do.
  const V to_third_x = hn::Add(flat.dx[0], flat.dx[1]), to_third_y = hn::Add(flat.dy[0], flat.dy[1]);
  const V ex = hn::Add(to_third_x, flat.dx[2]), ey = hn::Add(to_third_y, flat.dy[2]);
  const V c0 = cross(ex, ey, flat.x[0], flat.y[0]);
  const V a = cross(ex, ey, flat.dx[0], flat.dy[0]), b = cross(ex, ey, to_third_x, to_third_y);
  const V zero = hn::Zero(kFloats), most = all(0.75f);
  const V high = hn::Add(c0, hn::Mul(most, hn::Max(zero, hn::Max(a, b))));
  const V low = hn::Add(c0, hn::Mul(most, hn::Min(zero, hn::Min(a, b))));
  const V reach = hn::Mul(curves.most_radius(), hn::Sqrt(dot(ex, ey, ex, ey)));
  const uint32_t near_strip = bits_of<float>(hn::And(hn::Le(low, reach), hn::Ge(hn::Add(high, reach), zero)));
  if (near_strip == 0) return false;

  flat.add_points();
  V end_x, end_y;
  flatten_ends(curves, ray, end_x, end_y);
  const Minima minima(flat, end_x, end_y);
  const uint32_t single = minima.single & near_strip, folded = minima.folded & near_strip;
  if ((single | folded) == 0) return false;

  V r[4], z[4];
  curves.load_radii(r);
  const auto load_depths = [&]() HWY_ATTR {
    const uint32_t i = ray.axis[0], j = ray.axis[1], k = ray.axis[2];
    const V di = all(ray.depth[i]), dj = all(ray.depth[j]), dk = all(ray.depth[k]);
    for (size_t p = 0; p < 4; ++p) {
      const V pi = curves.coordinates(kFloats, i, 4 * p), pj = curves.coordinates(kFloats, j, 4 * p),
              pk = curves.coordinates(kFloats, k, 4 * p);
      z[p] =
          hn::Sub(hn::Add(hn::Add(hn::Mul(di, pi), hn::Mul(dj, pj)), hn::Mul(dk, pk)), all(ray.origin_depth));
    }
  };
  const uint32_t* numbers = reinterpret_cast<const FurBlockHeader*>(block)->number;
  const auto lane_of = [&](uint32_t lane) HWY_ATTR {
    alignas(16) float values[4];
    FurLane result;
    const auto value = [&](V from) HWY_ATTR {
      hn::Store(from, kFloats, values);
      return values[lane];
    };
    for (int i = 0; i < 4; ++i) {
      result.x[i] = value(flat.x[i]), result.y[i] = value(flat.y[i]);
      result.z[i] = value(z[i]), result.r[i] = value(r[i]);
    }
    for (int i = 0; i < 3; ++i) result.dx[i] = value(flat.dx[i]), result.dy[i] = value(flat.dy[i]);
    result.end_x = value(end_x), result.end_y = value(end_y);
    return result;
  };

  if (single != 0) {
    const Cubic curve_x(flat.x[0], flat.dx), curve_y(flat.y[0], flat.dy);
    const V u = solve(flat, curve_x, curve_y, minima.f0, minima.f5, single);
    const V cx = curve_x.value(u), cy = curve_y.value(u);
    const V distance2 = dot(cx, cy, cx, cy);
    const Weights weights(u);
    const V radius = weights(r);
    uint32_t hits = bits_of<float>(hn::Lt(distance2, hn::Mul(radius, radius))) & single;
    if (hits != 0) {
      load_depths();
      const V side = cross(Derivatives(flat.dx, u).first, Derivatives(flat.dy, u).first, cx, cy);
      const V h = hn::CopySign(hn::Div(hn::Sqrt(distance2), radius), side);
      alignas(16) float us[4], ts[4], hs[4];
      hn::Store(weights(z), kFloats, ts);
      hn::Store(u, kFloats, us);
      hn::Store(h, kFloats, hs);
      for (; hits != 0; hits &= hits - 1) {
        const auto lane = static_cast<uint32_t>(std::countr_zero(hits));
        const uint32_t number = numbers[lane];
        if (!query.wants(ts[lane], number)) continue;
        if (is_on_start(ray, number) && is_start(ray, number, lane_of(lane), us[lane], ts[lane])) continue;
        if (query.take({ts[lane], number, us[lane], hs[lane]})) return true;
      }
    }
  }
  if (HWY_LIKELY(folded == 0)) return false;
  load_depths();
  for (uint32_t lanes = folded; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
    if (test_folded(lane_of(lane), numbers[lane], ray, query)) return true;
  }
  return false;
}

/// Wide blocks are rare.
template <bool kMoving, class Query>
HWY_NOINLINE bool test_wide_block(const std::byte* block, const FurRay& ray, Query& query) {
  return test_block<true, kMoving>(block, ray, query);
}

template <bool kMoving, class Query>
HWY_INLINE bool test_leaf(const FurTreeView& tree, FurReference leaf, const FurRay& ray, Query& query) {
  const std::byte* block = tree.leaves + leaf.leaf_offset();
  const size_t size = (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(tree.motion_keys);
  if constexpr (Query::kCounts) query.tests.segments += 4 * leaf.blocks();
  for (uint32_t i = 0; i < leaf.blocks(); ++i, block += size) {
    if (HWY_UNLIKELY(leaf.is_wide())) {
      if (test_wide_block<kMoving>(block, ray, query)) return true;
    } else if (test_block<false, kMoving>(block, ray, query)) {
      return true;
    }
  }
  return false;
}
