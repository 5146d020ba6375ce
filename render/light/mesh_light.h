// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "render/light/light.h"

namespace pelage {

/// A mesh of triangles of constant radiance that emits from its outer sides, uniformly sampled in area. The
/// mesh covers itself: of the points on a line, the nearest one alone is seen, and none if the line meets the
/// inner side first. Everything else ignores that it is there.
class MeshLight final : public Light {
 public:
  /// A triangle whose corners turn left as seen from the emitting side.
  struct Triangle {
    V3f corners[3];
  };

  /// Returns the memory, in bytes, that a light of so many triangles takes at most.
  static int64_t bytes(size_t triangles) {
    return static_cast<int64_t>(triangles * (sizeof(Triangle) + sizeof(float) + 2 * sizeof(Node)));
  }

  /// `triangles`: at least one with an area, none twice. `charge`: for bytes().
  MeshLight(std::string name, std::vector<Triangle> triangles, const Rgb& radiance, bool visible,
            MemoryCharge charge = {});

  std::optional<LightSample> sample(const V3f& from, const V2f& u) const override;
  float pdf(const V3f& from, const V3f& direction) const override;
  float pdf_of_hit(const V3f& from, const V3f& direction, const LightHit& hit) const override;
  std::optional<LightHit> intersect(const V3f& from, const V3f& direction) const override;
  /// As Light::importance(), with the mean solid angle of a convex body with this area in the same ball.
  float importance(const V3f& from) const override;
  std::optional<LightBall> ball() const override { return ball_; }

  float area() const { return area_; }

 private:
  /// Of a tree of boxes: the first child follows its node, the second is at `second`.
  struct Node {
    Box3f box;
    uint32_t second = 0;            // 0: a leaf
    uint32_t first = 0, count = 0;  // triangles of a leaf
  };
  struct Crossing {
    float distance = std::numeric_limits<float>::infinity();
    uint32_t triangle = 0;
  };
  void build(uint32_t first, uint32_t count);
  std::optional<Crossing> nearest(const V3f& from, const V3f& direction) const;
  V3f normal(uint32_t triangle) const;

  MemoryCharge charge_;
  std::vector<Triangle> triangles_;
  std::vector<float> below_;  // by triangle: area of those before it and its own, relative to all
  std::vector<Node> nodes_;
  LightBall ball_;
  float area_ = 0;
  Rgb radiance_;
};

}  // namespace pelage
