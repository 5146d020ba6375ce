// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/light/light.h"

namespace pelage {

/// A binary tree over lights at finite distances, for random selection among many lights [Conty18]. A node
/// stands for the lights below it: their importance is estimated from their total power and the ball around
/// them. We deviate in two ways: there are no cones of normals, because the exact importance of a leaf is 0
/// behind a light; and each point uses a cut of the tree, for which the caller compares the scattering of
/// the point. Immutable.
class LightTree {
 public:
  /// Max count of nodes of a cut.
  static constexpr size_t kMaxCut = 8;

  LightTree() = default;
  /// `lights`: those that are infinitely far are left out. The lights must outlive the tree.
  explicit LightTree(const std::vector<std::unique_ptr<Light>>& lights);

  bool empty() const { return nodes_.empty(); }
  /// Fills `cut` with nodes that together contain each light once, and `importances` with their importance().
  /// Divides nodes that look large or important from `from`.
  void cut(const V3f& from, std::vector<uint32_t>& cut, std::vector<float>& importances) const;
  /// Divides the lights into at most `count` groups of neighbours, by power. Writes the group of each light
  /// to `groups`, from index `first` on, and returns the count of groups.
  size_t group(size_t count, uint32_t first, std::span<uint32_t> groups) const;

  const V3f& center(uint32_t node) const { return nodes_[node].ball.center; }

  /// A random way from a node to a light.
  struct Way {
    uint32_t node = 0;
    float probability = 1;  ///< of the way so far; 0 if it ends at a node without light
    float u = 0;            ///< random number in [0, 1), rescaled to [0, 1) at each node
  };
  /// Leads ways that begin at nodes of a positive importance to their lights. Takes all ways down together: a
  /// single one would wait for memory and for divisions at each node.
  void descend(const V3f& from, std::span<Way> ways) const;
  /// Returns the light at the end of a way.
  size_t light(const Way& way) const { return nodes_[way.node].light; }
  /// Returns the node of `cut` that contains a light, as an index in `cut`, with the probability that
  /// descend() leads from this node to the light. `light`: not infinitely far.
  struct Place {
    size_t index = 0;
    float probability = 0;
  };
  Place find(size_t light, const V3f& from, std::span<const uint32_t> cut) const;

  /// Calls `visit(light)` for each light whose ball meets a line that starts at `from`. `direction`: unit.
  template <class Visit>
  void on_line(const V3f& from, const V3f& direction, const Visit& visit) const {
    for (uint32_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      const V3f to = node.ball.center - from;
      const float along = to.dot(direction);
      const float radius = kGrown * node.ball.radius + kRounding * (std::abs(along) + node.ball.radius);
      const bool meets = along > -radius && (to - along * direction).length2() <= radius * radius;
      if (meets && node.is_leaf()) visit(size_t{node.light});
      i = meets ? i + 1 : node.end;
    }
  }

 private:
  /// Balls are tested slightly larger, and more so far away, so that rounding loses no light.
  static constexpr float kGrown = 1.001f, kRounding = 4e-6f;

  /// The first child of a node follows the node.
  struct Node {
    LightBall ball;
    float power = 0;      // importance * distance^2 far away, summed over the lights
    uint32_t end = 0;     // index of the first node that is not below this one
    uint32_t parent = 0;  // the root is its own
    uint32_t second = 0;  // index of the second child; 0: this is a leaf
    uint32_t light = 0;   // of a leaf
    const Light* leaf = nullptr;
    bool is_leaf() const { return second == 0; }
  };
  /// What descend() needs of both children of a node, in one line of the processor's cache.
  struct alignas(64) Fork {
    float x[2], y[2], z[2];  // centres of the balls
    float radius2[2];        // squares of the radii
    float power[2];
    uint32_t child[2];  // indices; both 0 at a leaf
    bool has_leaf = false;
  };
  using Lights = std::vector<std::unique_ptr<Light>>;

  void build(const Lights& lights, std::span<uint32_t> of, uint32_t parent);
  void fork(uint32_t node);
  /// importance() and spread of both children, seen from a point; leaves have the spread 0, because nothing
  /// divides them.
  struct ForkSeen {
    float importance[2], spread[2];
  };
  ForkSeen look(const Fork& fork, const V3f& from) const;
  /// Returns the probability of the first child of a node; negative if neither child can contribute.
  float first_share(const Fork& fork, const V3f& from) const;
  /// Estimates Light::importance() of all lights of a node; exact for a single light.
  float importance(uint32_t node, const V3f& from) const;

  std::vector<Node> nodes_;
  std::vector<Fork> forks_;       // by node
  std::vector<uint32_t> leaves_;  // node of each light; unused for lights that are infinitely far
};

}  // namespace pelage
