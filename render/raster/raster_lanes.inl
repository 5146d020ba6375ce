// SPDX-License-Identifier: Apache-2.0
// Part of raster_kernels.cpp: lines side by side.

HWY_INLINE V all(float x) { return hn::Set(kFloats, x); }
HWY_INLINE V at(const float* values, size_t i) { return hn::LoadU(kFloats, values + i); }
HWY_INLINE V dot(V ax, V ay, V bx, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); }
HWY_INLINE V cross(V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); }

/// A vector in the tile's frame, the same for all lines.
struct Vector {
  V x, y, z;
  HWY_INLINE explicit Vector(const V3f& v) : x(all(v.x)), y(all(v.y)), z(all(v.z)) {}
  HWY_INLINE Vector(V vx, V vy, V vz) : x(vx), y(vy), z(vz) {}

  /// This vector, moved by the fraction f of a motion.
  HWY_INLINE Vector moved(const Vector& motion, V f) const {
    return {hn::Add(x, hn::Mul(f, motion.x)), hn::Add(y, hn::Mul(f, motion.y)),
            hn::Add(z, hn::Mul(f, motion.z))};
  }
};

/// Some lines.
template <bool kLens>
struct Lines {
  V ax, ay, bx, by;
  HWY_INLINE Lines(const TileLines::Arrays& lines, size_t i) : bx(at(lines.bx, i)), by(at(lines.by, i)) {
    ax = kLens ? at(lines.ax, i) : hn::Zero(kFloats);
    ay = kLens ? at(lines.ay, i) : hn::Zero(kFloats);
  }
  /// A direction as seen along the lines.
  HWY_INLINE V seen_x(const Vector& v) const { return hn::Sub(v.x, hn::Mul(v.z, bx)); }
  HWY_INLINE V seen_y(const Vector& v) const { return hn::Sub(v.y, hn::Mul(v.z, by)); }
  /// Position of a point relative to the lines.
  HWY_INLINE V beside_x(const Vector& v) const { return kLens ? hn::Sub(seen_x(v), ax) : seen_x(v); }
  HWY_INLINE V beside_y(const Vector& v) const { return kLens ? hn::Sub(seen_y(v), ay) : seen_y(v); }
};

/// Fractions of the way between two motion keys; sets `inside` to lines of these times.
HWY_INLINE V key_fraction(const TileLines::Arrays& lines, size_t i, const KeySpan& keys, M& inside) {
  const V f = hn::Sub(hn::Mul(at(lines.time, i), all(keys.scale)), all(keys.first));
  inside = hn::And(inside, hn::Ge(f, hn::Zero(kFloats)));
  if (!keys.is_last) inside = hn::And(inside, hn::Lt(f, all(1)));
  return f;
}

/// Stores the depths of the lines `hit`, which is not empty, and their winner. `u`: of the segment, for the
/// filter.
HWY_INLINE bool store(const RasterTarget& target, size_t i, M hit, V z, V u) {
  const TileLines::Arrays& lines = target.lines;
  const V depth = at(lines.depth, i);
  const M nearer = hn::Lt(z, depth);
  const M usual = hn::And(nearer, hn::Gt(z, all(target.certain)));
  if (target.filter || !hn::AllTrue(kFloats, hn::Or(hn::Not(hit), usual))) {
    float us[TileLines::kPadding], zs[TileLines::kPadding];
    uint8_t bits[8] = {};
    hn::StoreU(u, kFloats, us);
    hn::StoreU(z, kFloats, zs);
    hn::StoreMaskBits(kFloats, hit, bits);
    bool changed = false;
    for (uint32_t lanes = bits[0] | uint32_t{bits[1]} << 8; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(lanes));
      const size_t line = i + lane;
      if (target.filter && !target.filter->stops(lines.random[line], us[lane])) continue;
      const bool same = lines.chunk[line] == target.chunk && lines.primitive[line] == target.primitive;
      const bool tie = zs[lane] == lines.depth[line];
      if (tie && same) continue;
      lines.depth[line] = zs[lane];
      lines.chunk[line] = tie || !(zs[lane] > target.certain) ? TileWinner::kTraced : target.chunk;
      lines.primitive[line] = target.primitive;
      changed = true;
    }
    return changed;
  }
  hn::StoreU(hn::IfThenElse(hit, z, depth), kFloats, lines.depth + i);
  const auto words = hn::RebindMask(kWords, hit);
  hn::StoreU(hn::IfThenElse(words, hn::Set(kWords, target.chunk), hn::LoadU(kWords, lines.chunk + i)), kWords,
             lines.chunk + i);
  hn::StoreU(hn::IfThenElse(words, hn::Set(kWords, target.primitive), hn::LoadU(kWords, lines.primitive + i)),
             kWords, lines.primitive + i);
  return true;
}
