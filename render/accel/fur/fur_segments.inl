// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: intersection of a ray with blocks of four segments.

/// Everything about the four curves of a block that are near a ray.
struct NearCurves {
  FlatCurves flat;
  V end_x, end_y, r[4];
  Depths depths;
};

HWY_NOINLINE FurLane lane_of(const NearCurves& curves, uint32_t lane) {
  alignas(16) float values[4];
  const auto value = [&](V from) HWY_ATTR {
    hn::Store(from, kFloats, values);
    return values[lane];
  };
  FurLane result;
  for (int i = 0; i < 4; ++i) {
    result.x[i] = value(curves.flat.x[i]), result.y[i] = value(curves.flat.y[i]);
    result.r[i] = value(curves.r[i]);
  }
  for (int i = 0; i < 3; ++i) {
    result.dx[i] = value(curves.flat.dx[i]), result.dy[i] = value(curves.flat.dy[i]);
    result.dz[i] = value(curves.depths.differences[i]);
  }
  result.z = value(curves.depths.first);
  result.end_x = value(curves.end_x), result.end_y = value(curves.end_y);
  return result;
}

/// Tests the curves of one block. Returns true when the ray is finished.
template <bool kWide, Motion kMotion, class Query>
PELAGE_FUR_INLINE bool test_block(const std::byte* block, const FurRay& ray, int motion_keys, Query& query) {
  const Block<kWide, kMotion> curves(block, ray, motion_keys);
  FlatCurves flat;
  flatten(curves, ray, flat);

  // The curve lies within a strip along its chord: a cubic deviates from the chord by at most 3/4 of the
  // deviation of its inner points.
  const V to_third_x = hn::Add(flat.dx[0], flat.dx[1]), to_third_y = hn::Add(flat.dy[0], flat.dy[1]);
  const V ex = hn::Add(to_third_x, flat.dx[2]), ey = hn::Add(to_third_y, flat.dy[2]);
  const V c0 = cross(ex, ey, flat.x[0], flat.y[0]);
  const V a = cross(ex, ey, flat.dx[0], flat.dy[0]), b = cross(ex, ey, to_third_x, to_third_y);
  const V zero = hn::Zero(kFloats), max = all(0.75f);
  const V high = hn::Add(c0, hn::Mul(max, hn::Max(zero, hn::Max(a, b))));
  const V low = hn::Add(c0, hn::Mul(max, hn::Min(zero, hn::Min(a, b))));
  const V reach =
      hn::Mul(hn::Add(curves.max_radius(), all(ray.point_error_bound)), hn::Sqrt(dot(ex, ey, ex, ey)));
  const uint32_t near_strip = bits_of<float>(hn::And(hn::Le(low, reach), hn::Ge(hn::Add(high, reach), zero)));
  if (near_strip == 0) return false;

  V end_x, end_y;
  flatten_point(curves, ray, 0, flat.x[0], flat.y[0]);
  flatten_point(curves, ray, 3, end_x, end_y);
  flat.add_points();
  const Minima minima(flat, end_x, end_y);
  const uint32_t single = minima.single & near_strip, folded = minima.folded & near_strip;
  if ((single | folded) == 0) return false;

  V r[4];
  curves.load_radii(r);
  V u = zero, h = zero;
  uint32_t hits = 0;
  if (single != 0) {
    const Cubic curve_x(flat.x[0], flat.dx), curve_y(flat.y[0], flat.dy);
    u = solve(flat, curve_x, curve_y, minima.f0, minima.f5, single);
    const V cx = curve_x.value(u), cy = curve_y.value(u);
    const V distance2 = dot(cx, cy, cx, cy);
    const V radius = Weights(u)(r);
    hits = bits_of<float>(hn::Lt(distance2, hn::Mul(radius, radius))) & single;
    if (hits != 0) {
      const V side = cross(Derivatives(flat.dx, u).first, Derivatives(flat.dy, u).first, cx, cy);
      h = hn::CopySign(hn::Div(hn::Sqrt(distance2), radius), side);
    }
  }
  if ((hits | folded) == 0) return false;

  const Depths depths(curves, ray);
  const uint32_t* numbers = reinterpret_cast<const FurBlockHeader*>(block)->number;
  // A copy, so that the vectors above may stay in registers.
  const auto lane_at = [&](uint32_t lane) HWY_ATTR {
    return lane_of({flat, end_x, end_y, {r[0], r[1], r[2], r[3]}, depths}, lane);
  };
  alignas(16) float us[4], ts[4], hs[4];
  hn::Store(u, kFloats, us);
  hn::Store(depths.at(Weights(u)), kFloats, ts);
  hn::Store(h, kFloats, hs);
  for (; hits != 0; hits &= hits - 1) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(hits));
    const uint32_t number = numbers[lane];
    if (!query.wants(ts[lane], number)) continue;
    if (is_on_start(ray, number) && is_start(ray, number, lane_at(lane), us[lane], ts[lane])) continue;
    if (query.take({ts[lane], number, us[lane], hs[lane]})) return true;
  }
  for (uint32_t lanes = folded; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(lanes));
    if (test_folded(lane_at(lane), numbers[lane], ray, query)) return true;
  }
  return false;
}

/// Wide blocks are rare.
template <Motion kMotion, class Query>
HWY_NOINLINE bool test_wide_block(const std::byte* block, const FurRay& ray, int motion_keys, Query& query) {
  return test_block<true, kMotion>(block, ray, motion_keys, query);
}

template <Motion kMotion, class Query>
PELAGE_FUR_INLINE bool test_leaf(const FurTreeView& tree, FurReference leaf, const FurRay& ray,
                                 Query& query) {
  const std::byte* block = tree.leaves + leaf.leaf_offset();
  const size_t size = (leaf.is_wide() ? kWideBlock : kNarrowBlock).block(tree.motion_keys);
  for (uint32_t i = 0; i < leaf.blocks(); ++i, block += size) {
    if (HWY_UNLIKELY(leaf.is_wide())) {
      if (test_wide_block<kMotion>(block, ray, tree.motion_keys, query)) return true;
    } else if (test_block<false, kMotion>(block, ray, tree.motion_keys, query)) {
      return true;
    }
  }
  return false;
}
