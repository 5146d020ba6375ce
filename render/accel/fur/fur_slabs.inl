// SPDX-License-Identifier: Apache-2.0
// Part of fur_kernels.cpp: intersection of a ray with the boxes of nodes.

/// A ray against the four boxes of a node.
template <bool kMoving>
class QuantisedSlabs {
 public:
  PELAGE_FUR_INLINE explicit QuantisedSlabs(const FurRay& ray)
      : key_(FurQuantisedNode::kPlanes + static_cast<size_t>(ray.key) * FurQuantisedNode::kKey),
        before_(all(1 - ray.fraction)),
        after_(all(ray.fraction)),
        inverse_(hn::Load(kFloats, ray.inverse)),
        near_origin_(hn::Load(kFloats, ray.near_origin)),
        far_origin_(hn::Load(kFloats, ray.far_origin)) {
    for (size_t axis = 0; axis < 3; ++axis) {
      near_side_[axis] = axis * FurQuantisedNode::kAxis + ray.near_side[axis] * FurQuantisedNode::kSide;
    }
  }
  PELAGE_FUR_INLINE const uint32_t* references(const std::byte* node) const {
    return reinterpret_cast<const uint32_t*>(node + FurQuantisedNode::kReferences);
  }
  PELAGE_FUR_INLINE hn::Mask<Floats> intersect(const std::byte* node, V& enter, V leave) const {
    const V origin = hn::LoadU(kFloats, reinterpret_cast<const float*>(node + FurQuantisedNode::kOrigin));
    const V scale = hn::LoadU(kFloats, reinterpret_cast<const float*>(node + FurQuantisedNode::kScale));
    const V step = hn::Mul(scale, inverse_);
    const V first = hn::Mul(hn::Sub(origin, near_origin_), inverse_);
    const V last = hn::Mul(hn::Sub(origin, far_origin_), inverse_);
    node += key_;
    intersect_axis<0>(node, step, first, last, enter, leave);
    intersect_axis<1>(node, step, first, last, enter, leave);
    intersect_axis<2>(node, step, first, last, enter, leave);
    return hn::Le(enter, leave);
  }

 private:
  template <int kAxis>
  PELAGE_FUR_INLINE void intersect_axis(const std::byte* planes, V step, V first, V last, V& enter,
                                        V& leave) const {
    const V steps = hn::Broadcast<kAxis>(step);
    const V near_side = side(planes + near_side_[kAxis]);
    const V far_side = side(planes + (near_side_[kAxis] ^ FurQuantisedNode::kSide));
    enter = hn::Max(hn::Add(hn::Mul(near_side, steps), hn::Broadcast<kAxis>(first)), enter);
    leave = hn::Min(hn::Add(hn::Mul(far_side, steps), hn::Broadcast<kAxis>(last)), leave);
  }
  PELAGE_FUR_INLINE V side(const std::byte* place) const {
    const V a = bytes_at(place);
    if constexpr (!kMoving) return a;
    return hn::Add(hn::Mul(a, before_), hn::Mul(bytes_at(place + FurQuantisedNode::kKey), after_));
  }
  size_t key_;
  V before_, after_, inverse_, near_origin_, far_origin_;
  size_t near_side_[3];
};
