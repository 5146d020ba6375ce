// SPDX-License-Identifier: Apache-2.0
#include "render/light/light_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "render/sampling/warp.h"

namespace pelage {
namespace {

/// Probability of a child that can contribute, at least: the estimates of importance may be wrong.
constexpr float kLeastShare = 0.1f;
/// Nodes that look smaller than this, as (radius / distance)^2, are not divided.
constexpr float kSmall = 0.01f;

/// Measures importance * distance^2 far from a light, in many directions.
float power_of(const Light& light, const LightBall& ball) {
  const float distance = 100 * ball.radius;
  float sum = 0;
  int count = 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const V3f direction(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        if (direction == V3f(0)) continue;
        sum += light.importance(ball.center + distance * direction.normalized());
        ++count;
      }
    }
  }
  return sum / static_cast<float>(count) * distance * distance;
}

/// (radius / distance)^2 of a ball; 1 from inside.
float spread(const LightBall& ball, const V3f& from) {
  const float radius2 = ball.radius * ball.radius;
  return radius2 / std::max((ball.center - from).length2(), radius2);
}

}  // namespace

LightTree::LightTree(const Lights& lights) : leaves_(lights.size()) {
  std::vector<uint32_t> near;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!lights[i]->is_infinitely_far()) near.push_back(i);
  }
  if (near.empty()) return;
  nodes_.reserve(2 * near.size() - 1);
  build(lights, near, 0);
  forks_.resize(nodes_.size());
  for (uint32_t i = 0; i < nodes_.size(); ++i) fork(i);
}

void LightTree::fork(uint32_t index) {
  Fork& fork = forks_[index];
  fork.child[0] = fork.child[1] = 0;
  if (nodes_[index].is_leaf()) return;
  fork.child[0] = index + 1, fork.child[1] = nodes_[index].second;
  for (size_t i = 0; i < 2; ++i) {
    const Node& child = nodes_[fork.child[i]];
    fork.x[i] = child.ball.center.x, fork.y[i] = child.ball.center.y, fork.z[i] = child.ball.center.z;
    fork.radius2[i] = child.ball.radius * child.ball.radius;
    fork.power[i] = child.power;
    fork.has_leaf = fork.has_leaf || child.is_leaf();
  }
}

void LightTree::build(const Lights& lights, std::span<uint32_t> of, uint32_t parent) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({});
  Node node;
  node.parent = parent;
  if (of.size() == 1) {
    node.light = of.front();
    node.leaf = lights[of.front()].get();
    node.ball = *node.leaf->ball();
    node.power = power_of(*node.leaf, node.ball);
    leaves_[of.front()] = index;
  } else {
    const auto ball = [&](uint32_t i) { return *lights[i]->ball(); };
    Box3f centers;
    for (const uint32_t i : of) centers.extendBy(ball(i).center);
    const auto axis = static_cast<int>(centers.majorAxis());
    const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
    std::nth_element(of.begin(), middle, of.end(), [&](uint32_t a, uint32_t b) {
      const float at_a = ball(a).center[axis], at_b = ball(b).center[axis];
      return at_a < at_b || (at_a == at_b && a < b);
    });
    node.ball.center = centers.center();
    for (const uint32_t i : of)
      node.ball.radius =
          std::max(node.ball.radius, (ball(i).center - node.ball.center).length() + ball(i).radius);
    build(lights, of.first(of.size() / 2), index);
    const auto second = static_cast<uint32_t>(nodes_.size());
    build(lights, of.subspan(of.size() / 2), index);
    node.second = second;
    node.power = nodes_[index + 1].power + nodes_[second].power;
  }
  node.end = static_cast<uint32_t>(nodes_.size());
  nodes_[index] = node;
}

float LightTree::importance(uint32_t index, const V3f& from) const {
  const Node& node = nodes_[index];
  if (node.is_leaf()) return node.leaf->importance(from);
  return node.power / std::max((node.ball.center - from).length2(), node.ball.radius * node.ball.radius);
}

// Inlined although it is large: half the time of selecting a light is spent here.
[[gnu::always_inline]] inline LightTree::ForkSeen LightTree::look(const Fork& fork, const V3f& from) const {
  ForkSeen seen;
  for (size_t i = 0; i < 2; ++i) {
    const float x = fork.x[i] - from.x, y = fork.y[i] - from.y, z = fork.z[i] - from.z;
    const float distance2 = std::max(x * x + y * y + z * z, fork.radius2[i]);
    seen.importance[i] = fork.power[i] / distance2;
    seen.spread[i] = fork.radius2[i] / distance2;
  }
  if (!fork.has_leaf) return seen;
  for (size_t i = 0; i < 2; ++i) {
    if (const Light* leaf = nodes_[fork.child[i]].leaf) {
      seen.importance[i] = leaf->importance(from);
      seen.spread[i] = 0;
    }
  }
  return seen;
}

void LightTree::cut(const V3f& from, std::vector<uint32_t>& cut, std::vector<float>& importances) const {
  cut.clear();
  importances.clear();
  if (empty()) return;
  cut.resize(kMaxCut);
  importances.resize(kMaxCut);
  cut[0] = 0;
  importances[0] = importance(0, from);
  float gains[kMaxCut];  // what dividing a node may gain; 0 if nothing
  const auto gain = [](float size, float importance) { return size > kSmall ? size * importance : 0.0f; };
  gains[0] = nodes_[0].is_leaf() ? 0.0f : gain(spread(nodes_[0].ball, from), importances[0]);
  size_t count = 1;
  while (count < kMaxCut) {
    size_t best = 0;
    float most = gains[0];
    for (size_t i = 1; i < count; ++i) {  // without branches, unlike std::max_element()
      best = gains[i] > most ? i : best;
      most = gains[i] > most ? gains[i] : most;
    }
    if (!(most > 0)) break;
    const Fork& fork = forks_[cut[best]];
    const ForkSeen seen = look(fork, from);
    for (const size_t i : {0, 1}) {
      const size_t place = i == 0 ? best : count;
      cut[place] = fork.child[i];
      importances[place] = seen.importance[i];
      gains[place] = gain(seen.spread[i], seen.importance[i]);
    }
    ++count;
  }
  cut.resize(count);
  importances.resize(count);
}

size_t LightTree::group(size_t count, uint32_t first, std::span<uint32_t> groups) const {
  if (empty()) return 0;
  std::vector<uint32_t> nodes = {0};
  const auto gain = [&](uint32_t node) { return nodes_[node].is_leaf() ? -1.0f : nodes_[node].power; };
  while (nodes.size() < count) {
    const auto best = std::max_element(nodes.begin(), nodes.end(),
                                       [&](uint32_t a, uint32_t b) { return gain(a) < gain(b); });
    if (nodes_[*best].is_leaf()) break;
    const uint32_t node = std::exchange(*best, *best + 1);
    nodes.push_back(nodes_[node].second);
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (uint32_t node = nodes[i]; node < nodes_[nodes[i]].end; ++node) {
      if (nodes_[node].is_leaf()) groups[nodes_[node].light] = first + static_cast<uint32_t>(i);
    }
  }
  return nodes.size();
}

float LightTree::first_share(const Fork& fork, const V3f& from) const {
  const auto [a, b] = look(fork, from).importance;
  if (!(b > 0)) return a > 0 ? 1.0f : -1.0f;
  if (!(a > 0)) return 0;
  return kLeastShare + (1 - 2 * kLeastShare) / (1 + b / a);
}

void LightTree::descend(const V3f& from, std::span<Way> ways) const {
  for (bool moves = true; moves;) {
    moves = false;
    for (Way& way : ways) {
      const Fork& fork = forks_[way.node];
      if (fork.child[0] == 0 || !(way.probability > 0)) continue;
      const float share = first_share(fork, from);
      // Tables instead of branches, which no processor could predict.
      const size_t child = way.u < share ? 0 : 1;
      const float shares[] = {share, 1 - share}, before[] = {0, share};
      way.u = std::min((way.u - before[child]) / shares[child], kBelowOne);
      way.probability = share < 0 ? 0.0f : way.probability * shares[child];
      way.node = fork.child[child];
      moves = true;
    }
  }
}

LightTree::Place LightTree::find(size_t light, const V3f& from, std::span<const uint32_t> cut) const {
  float probability = 1;
  for (uint32_t node = leaves_[light];; node = nodes_[node].parent) {
    const auto at = std::find(cut.begin(), cut.end(), node);
    if (at != cut.end()) return {static_cast<size_t>(at - cut.begin()), probability};
    PELAGE_CHECK(node != 0);
    const uint32_t parent = nodes_[node].parent;
    const float share = first_share(forks_[parent], from);
    if (share < 0) return {};
    probability *= node == parent + 1 ? share : 1 - share;
  }
}

}  // namespace pelage
