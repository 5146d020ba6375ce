// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: transforms the curves of a block to ray space.

/// The first points of a block in ray space, with an error of at most point_error_bound, and the differences
/// of the others, with an error relative to their size.
template <class Curves>
PELAGE_FUR_INLINE void flatten(const Curves& curves, const FurRay& ray, FlatCurves& flat) {
  alignas(64) float xs[16], ys[16];
  const auto set = [](float value) HWY_ATTR { return hn::Set(kMany, value); };
  const auto origin_x = static_cast<float>(ray.origin_x), origin_y = static_cast<float>(ray.origin_y);
  for (size_t i = 0; i < 16; i += hn::MaxLanes(kMany)) {
    const auto pi = curves.differences(kMany, ray.axis[0], i);
    const auto pj = curves.differences(kMany, ray.axis[1], i);
    const auto pk = curves.differences(kMany, ray.axis[2], i);
    const auto wide_x = hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pi), hn::Mul(set(ray.along_i), pk)),
                                of_first_point(kMany, i, set(origin_x)));
    const auto wide_y = hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pj), hn::Mul(set(ray.along_j), pk)),
                                of_first_point(kMany, i, set(origin_y)));
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

/// One Bezier point of all curves in ray space. A function of the ray and the point, so that both segments at
/// a joint get the same. Rounded once without motion: the product of two floats is exact in double.
template <class Curves>
PELAGE_FUR_INLINE void flatten_point(const Curves& curves, const FurRay& ray, size_t point, V& x, V& y) {
  const hn::Rebind<float, Doubles> floats;
  alignas(16) float xs[4], ys[4];
  const auto set = [](double value) HWY_ATTR { return hn::Set(kDoubles, value); };
  for (size_t lane = 0; lane < 4; lane += hn::MaxLanes(kDoubles)) {
    const auto pi = curves.coordinates(ray.axis[0], point, lane);
    const auto pj = curves.coordinates(ray.axis[1], point, lane);
    const auto pk = curves.coordinates(ray.axis[2], point, lane);
    const auto wide_x =
        hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pi), hn::Mul(set(ray.along_i), pk)), set(ray.origin_x));
    const auto wide_y =
        hn::Sub(hn::Sub(hn::Mul(set(ray.along_k), pj), hn::Mul(set(ray.along_j), pk)), set(ray.origin_y));
    hn::Store(hn::DemoteTo(floats, wide_x), floats, xs + lane);
    hn::Store(hn::DemoteTo(floats, wide_y), floats, ys + lane);
  }
  const V wide_x = hn::Load(kFloats, xs), wide_y = hn::Load(kFloats, ys);
  x = hn::Mul(wide_x, all(ray.scale_x));
  y = hn::Sub(hn::Mul(wide_y, all(ray.scale_y)), hn::Mul(wide_x, all(ray.shear_y)));
}

/// Distance of four curves along the ray: of the first point, rounded once, and by differences from there on.
struct Depths {
  V first, differences[3];

  template <class Curves>
  PELAGE_FUR_INLINE Depths(const Curves& curves, const FurRay& ray) {
    const hn::Rebind<float, Doubles> floats;
    alignas(64) float zs[16];
    const auto along = [&](auto d, auto pi, auto pj, auto pk) HWY_ATTR {
      using T = hn::TFromD<decltype(d)>;
      const auto product = [&](uint32_t axis, auto p)
                               HWY_ATTR { return hn::Mul(hn::Set(d, static_cast<T>(ray.depth[axis])), p); };
      return hn::Add(hn::Add(product(ray.axis[0], pi), product(ray.axis[1], pj)), product(ray.axis[2], pk));
    };
    for (size_t i = 0; i < 16; i += hn::MaxLanes(kMany)) {
      hn::Store(along(kMany, curves.differences(kMany, ray.axis[0], i),
                      curves.differences(kMany, ray.axis[1], i), curves.differences(kMany, ray.axis[2], i)),
                kMany, zs + i);
    }
    for (size_t lane = 0; lane < 4; lane += hn::MaxLanes(kDoubles)) {
      const auto z =
          along(kDoubles, curves.coordinates(ray.axis[0], 0, lane), curves.coordinates(ray.axis[1], 0, lane),
                curves.coordinates(ray.axis[2], 0, lane));
      hn::Store(hn::DemoteTo(floats, hn::Sub(z, hn::Set(kDoubles, ray.origin_depth))), floats, zs + lane);
    }
    first = hn::Load(kFloats, zs);
    for (size_t i = 0; i < 3; ++i) differences[i] = hn::Load(kFloats, zs + 4 * (i + 1));
  }

  PELAGE_FUR_INLINE V at(const Weights& weights) const {
    const V second = hn::Add(differences[0], differences[1]);
    const V from_first = hn::Add(
        hn::Mul(weights.w[1], differences[0]),
        hn::Add(hn::Mul(weights.w[2], second), hn::Mul(weights.w[3], hn::Add(second, differences[2]))));
    return hn::Add(first, from_first);
  }
};
