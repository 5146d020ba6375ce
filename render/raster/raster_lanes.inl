// SPDX-License-Identifier: Apache-2.0
// Part of raster_kernels.cpp: lines side by side.

HWY_INLINE V all(float x) { return hn::Set(kFloats, x); }
HWY_INLINE V at(const float* values, size_t i) { return hn::LoadU(kFloats, values + i); }
HWY_INLINE V at(const float* values, Indices i) { return hn::GatherIndex(kFloats, values, i); }
HWY_INLINE uint32_t bits_of(M mask) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(kFloats, mask, bits);
  return bits[0] | uint32_t{bits[1]} << 8;
}
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
  /// Consecutive lines.
  HWY_INLINE Lines(const TileLines::Arrays& lines, size_t i) : bx(at(lines.bx, i)), by(at(lines.by, i)) {
    ax = kLens ? at(lines.ax, i) : hn::Zero(kFloats);
    ay = kLens ? at(lines.ay, i) : hn::Zero(kFloats);
  }
  HWY_INLINE Lines(const TileLines::Arrays& lines, Indices i) : bx(at(lines.bx, i)), by(at(lines.by, i)) {
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
/// `i`: index of the first line, or the indices of all.
template <class Index>
HWY_INLINE V key_fraction(const TileLines::Arrays& lines, Index i, const KeySpan& keys, M& inside) {
  const V f = hn::Sub(hn::Mul(at(lines.time, i), all(keys.scale)), all(keys.first));
  inside = hn::And(inside, hn::Ge(f, hn::Zero(kFloats)));
  if (!keys.is_last) inside = hn::And(inside, hn::Lt(f, all(1)));
  return f;
}

/// Makes the primitive the winner of a line, unless a filter rejects it. `u`: of the segment, for the filter.
HWY_INLINE bool store_line(const RasterTarget& target, size_t line, float z, float u) {
  const TileLines::Arrays& lines = target.lines;
  if (target.filter && !target.filter->stops(lines.random[line], u)) return false;
  const bool same = lines.chunk[line] == target.chunk && lines.primitive[line] == target.primitive;
  const bool tie = z == lines.depth[line];
  if (tie && same) return false;
  lines.depth[line] = z;
  lines.chunk[line] = tie || !(z > target.certain) ? TileWinner::kTraced : target.chunk;
  lines.primitive[line] = target.primitive;
  return true;
}

/// Stores the depths of the lines `hit`, which is not empty, and their winner. `i`: index of the first line.
HWY_INLINE bool store(const RasterTarget& target, size_t i, M hit, V z) {
  const TileLines::Arrays& lines = target.lines;
  const V depth = at(lines.depth, i);
  const M usual = hn::And(hn::Lt(z, depth), hn::Gt(z, all(target.certain)));
  if (!hn::AllTrue(kFloats, hn::Or(hn::Not(hit), usual))) {
    float zs[TileLines::kPadding];
    hn::StoreU(z, kFloats, zs);
    bool changed = false;
    for (uint32_t lanes = bits_of(hit); lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(lanes));
      changed |= store_line(target, i + lane, zs[lane], 0);
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
