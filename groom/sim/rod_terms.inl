// SPDX-License-Identifier: Apache-2.0
// Part of rod_kernel.cpp: the linear system of a Newton iteration, as Rod::Assembly.

struct RodTerms {
  const RodPackView& pack;
  const RodPack::Step& step;
  V h, inverse_h2, rate;
  V3 gravity;
  double *start, *expected, *start_darboux, *root, *inverse_edge, *edges, *solution, *factors;

  RodTerms(const RodPackView& view, const RodPack::Step& of)
      : pack(view),
        step(of),
        h(all(of.seconds)),
        inverse_h2(all(1 / (of.seconds * of.seconds))),
        rate(all(view.damping / of.seconds)),
        gravity{all(of.gravity.x), all(of.gravity.y), all(of.gravity.z)} {
    const size_t n = view.segments;
    double* next = view.scratch;
    for (const auto& [member, numbers] : {std::pair{&start, 3 * n + 3},
                                          {&expected, 3 * n + 3},
                                          {&start_darboux, 3 * n},
                                          {&root, size_t(7)},
                                          {&inverse_edge, n},
                                          {&edges, 3 * n},
                                          {&solution, 4 * n + 4},
                                          {&factors, 34 * n + 28}}) {
      *member = next;
      next += numbers * kOwn;
    }
  }

  HWY_INLINE V inertia(size_t node) const { return number(pack.masses + node * kStride) * inverse_h2; }

  /// Adds s * I + t * u u^T to the block of two nodes.
  template <size_t kColumn, size_t kRow>
  HWY_INLINE static void add_block(Front& f, V s, V t, const V3& u) {
    const V a[3] = {u.x, u.y, u.z};
#pragma GCC unroll 3
    for (size_t c = 0; c < 3; ++c) {
      const V scaled = t * a[c];
#pragma GCC unroll 3
      for (size_t r = kRow == kColumn ? c : 0; r < 3; ++r) {
        V& element = f.matrix[kColumn + c][kRow + r];
        element = element + (r == c ? scaled * a[r] + s : scaled * a[r]);
      }
    }
  }
  template <size_t kRow>
  HWY_INLINE static void add_force(Front& f, const V3& force) {
    f.right[kRow] = f.right[kRow] + force.x;
    f.right[kRow + 1] = f.right[kRow + 1] + force.y;
    f.right[kRow + 2] = f.right[kRow + 2] + force.z;
  }

  /// A node that is the last one of the front, and the twist of the segment before it.
  HWY_INLINE void add_node(Front& f, size_t node) const {
    const V3 x = vector<kStride>(pack.positions, 3 * node), began = vector<kOwn>(start, 3 * node);
    const V heavy = inertia(node), drag = all(pack.drag) * number(pack.weights + node * kStride) / h;
    V3 slip = x - began;
    if (step.has_air) slip = slip - vector<kStride>(pack.air, 3 * node) * h;
    V3 force = (vector<kOwn>(expected, 3 * node) - x) * heavy - slip * drag;
    V diagonal = heavy + drag;
    for (size_t k = 0; k < step.planes; ++k) add_plane(f, node, k, x, heavy, force);
    add_block<8, 8>(f, diagonal, zero(), no_vector());
    add_force<8>(f, force);
    const V arm = hn::Max(number(pack.radius), all(0.01) * number(pack.lengths + (node - 1) * kStride));
    f.matrix[7][7] = f.matrix[7][7] + heavy * arm * arm * all(0.5);
  }

  HWY_INLINE void add_plane(Front& f, size_t node, size_t which, const V3& x, V heavy, V3& force) const {
    const size_t first = 6 * (RodPack::kMaxPlanes * node + which);
    const V3 local = vector<kStride>(pack.planes, first + 3), at = vector<kStride>(pack.planes, first);
    const Q frame{vector<kOwn>(root, 3), number(root + 6 * kOwn)};
    const V3 normal = turned(frame, local), point = vector<kOwn>(root, 0) + turned(frame, at);
    const V gap = dot(normal, x) - dot(normal, point);
    const M touches = hn::And(gap<zero(), dot(local, local)> zero());
    if (hn::AllFalse(kDoubles, touches)) return;
    const double softness = step.softness[which];
    V stiffness = heavy * all(kContactStiffness), rub = zero();
    V3 push = no_vector();
    if (softness > 0) {
      stiffness = number(pack.masses + node * kStride) * all(softness);
    } else {
      const Q old{vector<kStride>(pack.root, 3), number(pack.root + 6 * kStride)};
      const V3 was = vector<kStride>(pack.root, 0) + turned(old, at);
      V3 slip = x - vector<kOwn>(start, 3 * node) - (point - was);
      slip = slip - normal * dot(normal, slip);
      const V slid = hn::Sqrt(dot(slip, slip)), most = all(pack.friction) * stiffness * hn::Neg(gap);
      const V least = all(1e-12) * number(pack.length);
      rub = choose(most > zero(), hn::Min(stiffness, most / hn::Max(slid, least)), zero());
      push = slip * rub;
    }
    force = force - choose(touches, push + normal * (stiffness * gap), no_vector());
    add_block<8, 8>(f, choose(touches, rub, zero()), choose(touches, stiffness - rub, zero()), normal);
  }

  template <bool kRootMoves>
  HWY_INLINE void add_stretch(Front& f, size_t i) const {
    const V3 edge = vector<kStride>(pack.positions, 3 * i + 3) - vector<kStride>(pack.positions, 3 * i);
    const V now2 = dot(edge, edge), inverse = all(1) / hn::Sqrt(now2), now = now2 * inverse;
    const V3 along = edge * inverse;
    store(inverse, inverse_edge + i * kOwn);
    store_vector<kOwn>(along, edges, 3 * i);
    const V length = number(pack.lengths + i * kStride);
    const V stiffness = hn::Min(number(pack.stretch) / length, all(kStiffestRod) * inertia(i + 1));
    const V across = hn::Max(zero(), stiffness * (all(1) - length * inverse));
    const V3 force = along * (stiffness * (now - length));
    add_block<8, 8>(f, across, stiffness - across, along);
    add_force<8>(f, minus(force));
    if (!kRootMoves) return;
    add_block<4, 4>(f, across, stiffness - across, along);
    add_block<4, 8>(f, hn::Neg(across), across - stiffness, along);
    add_force<4>(f, force);
  }

  /// The joint before segment i. kFirst: the first unknown of the front that moves.
  template <size_t kFirst>
  HWY_INLINE void add_joint(Front& f, size_t i) const {
    const Q q0 =
        kFirst < 7 ? quaternion(pack.frames, 4 * i - 4) : Q{vector<kOwn>(root, 3), number(root + 6 * kOwn)};
    const Q q1 = quaternion(pack.frames, 4 * i);
    const V3 now = darboux(q0, q1), half = now * all(0.5);
    const V s = hn::Sqrt(hn::Max(zero(), all(1) - dot(half, half)));
    const V two = all(2), one = all(1);
    const V x = q0.v.x, y = q0.v.y, z = q0.v.z, w = q0.r;
    const V3 axes[3] = {{one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)},
                        {two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)},
                        third_axis(q0)};
    const V3 turns[3] = {axes[0] * s + axes[1] * half.z - axes[2] * half.y,
                         axes[1] * s - axes[0] * half.z + axes[2] * half.x,
                         axes[2] * s + axes[0] * half.y - axes[1] * half.x};
    const V length = number(pack.joint_lengths + i * kStride);
    const V segment = number(pack.lengths + i * kStride), inverse_length = one / length;
    const V limit = all(kStiffestRod) * inertia(i + 1) * segment * segment;
    const V bend = hn::Min(number(pack.bend) * inverse_length, limit);
    const V twist = hn::Min(number(pack.twist) * inverse_length, limit);
    const V3 lever1 = vector<kOwn>(edges, 3 * i) * number(inverse_edge + i * kOwn), d1 = third_axis(q1);
    const V3 rest = vector<kStride>(pack.rest_darboux, 3 * i);
    const V3 bent = now - rest + (now - vector<kOwn>(start_darboux, 3 * i)) * rate;
    V3 lever0 = no_vector();
    if (kFirst < 7) lever0 = vector<kOwn>(edges, 3 * i - 3) * number(inverse_edge + (i - 1) * kOwn);
#pragma GCC unroll 3
    for (size_t r = 0; r < 3; ++r) {
      const V3 at1 = cross(turns[r], lever1);
      const V t1 = dot(turns[r], d1);
      V3 at0 = no_vector();
      V t0 = zero();
      if (kFirst < 7) {
        at0 = cross(turns[r], lever0);
        t0 = hn::Neg(dot(turns[r], axes[2]));
      }
      const V3 middle = minus(at1 + at0);
      const V row[Front::kSize] = {at0.x,    at0.y, at0.z, t0,    middle.x, middle.y,
                                   middle.z, t1,    at1.x, at1.y, at1.z};
      const V stiffness = r < 2 ? bend : twist, force = stiffness * (r == 0   ? bent.x
                                                                     : r == 1 ? bent.y
                                                                              : bent.z);
      const V matrix = stiffness * (one + rate);
#pragma GCC unroll 11
      for (size_t c = kFirst; c < Front::kSize; ++c) {
        f.right[c] = f.right[c] - force * row[c];
        const V scaled = matrix * row[c];
#pragma GCC unroll 11
        for (size_t k = c; k < Front::kSize; ++k) f.matrix[c][k] = f.matrix[c][k] + scaled * row[k];
      }
    }
  }

  /// Sets `solution` to the Newton step: x, y, z of node i at 4 i, the twist of segment i at 4 i + 3.
  HWY_INLINE void solve(V& failed) const {
    const size_t n = pack.segments;
    Front f(factors, solution + 3 * kOwn, failed);
    add_node(f, 1);
    add_stretch<false>(f, 0);
    add_joint<7>(f, 0);
    for (size_t i = 1; i < n; ++i) {
      f.shift();
      add_node(f, i + 1);
      add_stretch<true>(f, i);
      if (i == 1) {
        add_joint<3>(f, i);
        f.eliminate<3, 4>();
      } else {
        add_joint<0>(f, i);
        f.eliminate<0, 4>();
      }
    }
    if (n == 1) {
      f.eliminate<7, 11>();
      f.substitute<0, 4>();
    } else {
      f.eliminate<4, 11>();
      f.substitute<0, 7>();
      for (size_t i = 2; i < n; ++i) f.substitute<7, 4>();
      f.substitute<7, 1>();
    }
    failed = f.failed;
  }
};
