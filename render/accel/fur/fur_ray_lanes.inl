// SPDX-License-Identifier: Apache-2.0
// Part of fur_segment_rays.cpp: one segment in the ray spaces of many rays. Compare fur_ray_space.inl and
// FurRay::prepare().

/// What is computed in double precision: the ray spaces, and the end points of the segment in them.
struct RayLanes {
  static constexpr size_t kMax = FurRayBatch::kMax;
  alignas(64) float scale_x[kMax], scale_y[kMax], shear_y[kMax];
  alignas(64) float origin_x[kMax], origin_y[kMax];  ///< X and Y of the ray's origin
  alignas(64) float depth[3][kMax];                  ///< by axis of the grid
  alignas(64) float first_x[kMax], first_y[kMax], first_z[kMax], end_x[kMax], end_y[kMax];
  uint32_t valid = 0;  ///< rays with a direction of valid length

  void prepare(const FurRayBatch& rays, const SnappedSegment& segment);
};

inline void RayLanes::prepare(const FurRayBatch& rays, const SnappedSegment& segment) {
  constexpr hn::CappedTag<double, kMax> d;
  const hn::Rebind<float, decltype(d)> floats;
  const uint32_t i = rays.axis[0], j = rays.axis[1], k = rays.axis[2];
  const auto set = [](double x) HWY_ATTR { return hn::Set(hn::CappedTag<double, kMax>(), x); };
  const auto put = [&](auto v, float* to) HWY_ATTR { hn::StoreU(hn::DemoteTo(floats, v), floats, to); };
  for (size_t lane = 0; lane < rays.count; lane += hn::MaxLanes(d)) {
    const auto along = [&](uint32_t axis) HWY_ATTR {
      return hn::PromoteTo(d, hn::LoadU(floats, rays.direction[axis] + lane));
    };
    const auto from = [&](uint32_t axis) HWY_ATTR { return hn::LoadU(d, rays.origin[axis] + lane); };
    const auto di = along(i), dj = along(j), dk = along(k);
    const auto length2 = hn::Add(hn::Add(hn::Mul(di, di), hn::Mul(dj, dj)), hn::Mul(dk, dk));
    const auto within = hn::And(hn::Gt(length2, set(0.25)), hn::Lt(length2, set(4)));
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, within, bits);
    valid |= uint32_t{bits[0]} << lane;
    const auto x = hn::Sub(hn::Mul(dk, from(i)), hn::Mul(di, from(k)));
    const auto y = hn::Sub(hn::Mul(dk, from(j)), hn::Mul(dj, from(k)));
    const auto first2 = hn::Add(hn::Mul(dk, dk), hn::Mul(di, di)), first = hn::Sqrt(first2);
    const auto second = hn::Div(first, hn::Mul(dk, hn::Sqrt(length2)));
    put(x, origin_x + lane);
    put(y, origin_y + lane);
    put(hn::Div(set(1), first), scale_x + lane);
    put(second, scale_y + lane);
    put(hn::Mul(second, hn::Div(hn::Mul(di, dj), first2)), shear_y + lane);
    const auto unit = hn::Div(set(1), length2);
    auto origin_depth = hn::Zero(d);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      put(hn::Mul(along(axis), unit), depth[axis] + lane);
      const auto rounded = hn::PromoteTo(d, hn::LoadU(floats, depth[axis] + lane));
      origin_depth = hn::Add(origin_depth, hn::Mul(rounded, from(axis)));
    }
    const auto flattened = [&](const auto& p, float* to_x, float* to_y) HWY_ATTR {
      put(hn::Sub(hn::Sub(hn::Mul(dk, set(p[i])), hn::Mul(di, set(p[k]))), x), to_x + lane);
      put(hn::Sub(hn::Sub(hn::Mul(dk, set(p[j])), hn::Mul(dj, set(p[k]))), y), to_y + lane);
    };
    flattened(segment[0], first_x, first_y);
    flattened(segment[3], end_x, end_y);
    const auto product = [&](uint32_t axis) HWY_ATTR {
      return hn::Mul(hn::PromoteTo(d, hn::LoadU(floats, depth[axis] + lane)), set(segment[0][axis]));
    };
    put(hn::Sub(hn::Add(hn::Add(product(i), product(j)), product(k)), origin_depth), first_z + lane);
  }
}

/// The segment in the ray spaces of the rays from `at` on.
class SegmentInRays {
 public:
  PELAGE_FUR_INLINE SegmentInRays(const FurRayBatch& rays, const RayLanes& lanes,
                                  const SnappedSegment& segment, size_t at)
      : lanes_(lanes), segment_(segment), axis_(rays.axis), at_(at) {
    const V di = load(rays.direction[axis_[0]]), dj = load(rays.direction[axis_[1]]),
            dk = load(rays.direction[axis_[2]]);
    for (size_t point = 0; point < 4; ++point) {
      const V pi = difference(point, axis_[0]), pj = difference(point, axis_[1]),
              pk = difference(point, axis_[2]);
      V x = hn::Sub(hn::Mul(dk, pi), hn::Mul(di, pk)), y = hn::Sub(hn::Mul(dk, pj), hn::Mul(dj, pk));
      if (point == 0) x = hn::Sub(x, load(lanes.origin_x)), y = hn::Sub(y, load(lanes.origin_y));
      V& to_x = point == 0 ? flat.x[0] : flat.dx[point - 1];
      V& to_y = point == 0 ? flat.y[0] : flat.dy[point - 1];
      orthonormalise(x, y, to_x, to_y);
    }
  }
  /// Replaces the first point by the accurate one, and computes the others and the last.
  PELAGE_FUR_INLINE void add_points() {
    orthonormalise(load(lanes_.first_x), load(lanes_.first_y), flat.x[0], flat.y[0]);
    orthonormalise(load(lanes_.end_x), load(lanes_.end_y), end_x, end_y);
    flat.add_points();
  }
  /// Distance along the rays.
  PELAGE_FUR_INLINE V depth(const Weights& weights) const {
    V d[3];
    for (size_t point = 1; point < 4; ++point) {
      const auto product = [&](uint32_t axis) HWY_ATTR {
        return hn::Mul(load(lanes_.depth[axis]), difference(point, axis));
      };
      d[point - 1] = hn::Add(hn::Add(product(axis_[0]), product(axis_[1])), product(axis_[2]));
    }
    const V second = hn::Add(d[0], d[1]);
    const V from_first =
        hn::Add(hn::Mul(weights.w[1], d[0]),
                hn::Add(hn::Mul(weights.w[2], second), hn::Mul(weights.w[3], hn::Add(second, d[2]))));
    return hn::Add(load(lanes_.first_z), from_first);
  }
  PELAGE_FUR_INLINE V load(const float* values) const { return hn::LoadU(kFloats, values + at_); }

  FlatCurves flat;
  V end_x, end_y;

 private:
  /// The first point, or the difference of a point from the one before.
  PELAGE_FUR_INLINE V difference(size_t point, uint32_t axis) const {
    return all(point == 0 ? segment_[0][axis] : segment_[point][axis] - segment_[point - 1][axis]);
  }
  PELAGE_FUR_INLINE void orthonormalise(V wide_x, V wide_y, V& x, V& y) const {
    x = hn::Mul(wide_x, load(lanes_.scale_x));
    y = hn::Sub(hn::Mul(wide_y, load(lanes_.scale_y)), hn::Mul(wide_x, load(lanes_.shear_y)));
  }

  const RayLanes& lanes_;
  const SnappedSegment& segment_;
  const uint32_t (&axis_)[3];
  const size_t at_;
};

/// Tests the rays from `at` on. `valid`: those to test, as bits. Returns those that it cannot decide.
PELAGE_FUR_INLINE uint32_t test_rays(const FurRayBatch& rays, const RayLanes& lanes,
                                     const SnappedSegment& segment, uint32_t number, size_t at,
                                     uint32_t valid, FurHit* hits) {
  SegmentInRays in_rays(rays, lanes, segment, at);
  FlatCurves& flat = in_rays.flat;
  valid &= lanes.valid >> at;
  // The strip along the chord, as in test_block().
  const V to_third_x = hn::Add(flat.dx[0], flat.dx[1]), to_third_y = hn::Add(flat.dy[0], flat.dy[1]);
  const V ex = hn::Add(to_third_x, flat.dx[2]), ey = hn::Add(to_third_y, flat.dy[2]);
  const V c0 = cross(ex, ey, flat.x[0], flat.y[0]);
  const V a = cross(ex, ey, flat.dx[0], flat.dy[0]), b = cross(ex, ey, to_third_x, to_third_y);
  const V zero = hn::Zero(kFloats), max = all(0.75f);
  const V high = hn::Add(c0, hn::Mul(max, hn::Max(zero, hn::Max(a, b))));
  const V low = hn::Add(c0, hn::Mul(max, hn::Min(zero, hn::Min(a, b))));
  const float max_radius = std::max({segment[0][3], segment[1][3], segment[2][3], segment[3][3]});
  const V reach =
      hn::Mul(hn::Add(all(max_radius), in_rays.load(rays.point_error_bound)), hn::Sqrt(dot(ex, ey, ex, ey)));
  const uint32_t near_strip =
      bits_of<float>(hn::And(hn::Le(low, reach), hn::Ge(hn::Add(high, reach), zero))) & valid;
  if (near_strip == 0) return 0;

  in_rays.add_points();
  const Minima minima(flat, in_rays.end_x, in_rays.end_y);
  const uint32_t single = minima.single & near_strip, folded = minima.folded & near_strip;
  if (single == 0) return folded;
  const V r[4] = {all(segment[0][3]), all(segment[1][3]), all(segment[2][3]), all(segment[3][3])};
  const Cubic curve_x(flat.x[0], flat.dx), curve_y(flat.y[0], flat.dy);
  const V u = solve(flat, curve_x, curve_y, minima.f0, minima.f5, single);
  const V cx = curve_x.value(u), cy = curve_y.value(u);
  const V distance2 = dot(cx, cy, cx, cy);
  const Weights weights(u);
  const V radius = weights(r);
  const V side = cross(Derivatives(flat.dx, u).first, Derivatives(flat.dy, u).first, cx, cy);
  const V h = hn::CopySign(hn::Div(hn::Sqrt(distance2), radius), side);
  const V t = in_rays.depth(weights);
  const auto between = hn::And(hn::Gt(t, in_rays.load(rays.near)), hn::Lt(t, in_rays.load(rays.far)));
  uint32_t in_reach = bits_of<float>(hn::And(hn::Lt(distance2, hn::Mul(radius, radius)), between)) & single;
  float us[FurRayBatch::kMax], ts[FurRayBatch::kMax], hs[FurRayBatch::kMax];
  hn::StoreU(u, kFloats, us);
  hn::StoreU(t, kFloats, ts);
  hn::StoreU(h, kFloats, hs);
  for (; in_reach != 0; in_reach &= in_reach - 1) {
    const auto lane = static_cast<size_t>(std::countr_zero(in_reach));
    hits[at + lane] = {ts[lane], number, us[lane], hs[lane]};
  }
  return folded;
}
