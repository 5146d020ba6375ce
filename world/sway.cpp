// SPDX-License-Identifier: Apache-2.0
#include "world/sway.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "groom/operators/follow.h"

namespace pelage {
namespace {

/// A vibration is forgotten where less than this fraction of it is left, and after kMaxHistory half frames.
constexpr double kForgotten = 0.01;
constexpr int kMaxHistory = 96;
/// Tips lag by at most this fraction of the length of their guides.
constexpr double kMostLag = 0.9;

/// A triangle's own axes, and the length of its first edge. All axes are 0 for a triangle without area.
struct TriangleSpace {
  V3d origin, x, y, z;
  double size;

  TriangleSpace(const V3f& a, const V3f& b, const V3f& c) : origin(a) {
    const V3d edge = V3d(b) - origin;
    size = edge.length();
    x = size > 0 ? edge / size : V3d(0);
    z = x.cross(V3d(c) - origin).normalized();
    y = z.cross(x);
  }
  V3d to_world(const V3d& p) const { return origin + (x * p.x + y * p.y + z * p.z) * size; }
  V3d to_local(const V3d& p) const {
    const V3d d = p - origin;
    return size > 0 ? V3d(d.dot(x), d.dot(y), d.dot(z)) / size : V3d(0);
  }
};

}  // namespace

Sway::Sway(const SceneDescription& scene, const Assets& assets, const FrameCharacter& character, size_t part,
           const Groom& groom, const DynamicsParams& params)
    : assets_(assets),
      character_(character),
      part_(part),
      segments_(static_cast<size_t>(groom.points() - 1)),
      step_(0.5 / scene.units.fps),
      frequency_(2 * std::numbers::pi * params.sway_frequency),
      damping_(params.sway_damping) {
  const Assets::Skin& skin = assets.skins.at(character.params->parts[part].skin.name);
  const ControlMesh& cage = skin.cage;
  std::vector<size_t> first{0};
  for (const auto size : cage.face_sizes) first.push_back(first.back() + static_cast<size_t>(size));
  const MovingGuides& guides = *groom.guides();
  for (size_t g = 0; g < guides.follicles.size(); ++g) {
    const RootAddress& root = groom.follicles().root(guides.follicles[g]);
    Foot foot;
    const size_t corner = first[skin.rest->topology().cage_face(root.face)];
    for (size_t k = 0; k < 3; ++k) foot.corners[k] = static_cast<uint32_t>(cage.face_vertices[corner + k]);
    const TriangleSpace space(cage.positions[foot.corners[0]], cage.positions[foot.corners[1]],
                              cage.positions[foot.corners[2]]);
    const V3d at(guides.roots.position(g));
    foot.root = space.to_local(at);
    foot.tip = space.to_local(at + V3d(guides.tips[g]));
    feet_.push_back(foot);
  }
}

Sway::Tips Sway::find_tips(int half) const {
  const std::vector<V3f> cage = posed_cage(character_, part_, assets_, 0.5 * half);
  Tips tips;
  tips.reserve(3 * feet_.size());
  for (const Foot& foot : feet_) {
    const TriangleSpace space(cage[foot.corners[0]], cage[foot.corners[1]], cage[foot.corners[2]]);
    const V3d tip = space.to_world(foot.tip);
    tips.insert(tips.end(), {tip.x, tip.y, tip.z});
  }
  return tips;
}

const Sway::Tips& Sway::tips(int half) {
  const auto found = known_.find(half);
  return found != known_.end() ? found->second : known_[half] = find_tips(half);
}

GuideTurns Sway::at(int half) {
  std::vector<double> lags(3 * feet_.size(), 0.0);
  const double quiet = frequency_ * std::sqrt(std::max(1e-6, 1 - damping_ * damping_));
  const double lasts = -std::log(kForgotten) / (std::max(1e-6, damping_) * frequency_ * step_);
  const int history = static_cast<int>(std::ceil(std::clamp(lasts, 1.0, double{kMaxHistory})));
  for (int k = 1; k <= history; ++k) {
    const Tips &after = tips(half - k + 1), &here = tips(half - k), &before = tips(half - k - 1);
    const double age = k * step_;
    // Fades to 0 at the end of the history, so that a long vibration does not stop at once.
    const double past = static_cast<double>(k) / (history + 1), fade = 1 - past * past * past * past;
    const double answer = fade * std::exp(-damping_ * frequency_ * age) * std::sin(quiet * age) / quiet;
    const double change = answer / step_;
    for (size_t i = 0; i < lags.size(); ++i) lags[i] -= (after[i] - here[i] * 2.0 + before[i]) * change;
  }
  const std::vector<V3f> cage = posed_cage(character_, part_, assets_, 0.5 * half);
  GuideTurns turns;
  turns.reserve(4 * feet_.size() * segments_);
  for (size_t g = 0; g < feet_.size(); ++g) {
    const Foot& foot = feet_[g];
    const TriangleSpace space(cage[foot.corners[0]], cage[foot.corners[1]], cage[foot.corners[2]]);
    const V3d along = space.to_world(foot.tip) - space.to_world(foot.root);
    const V3d behind(lags[3 * g], lags[3 * g + 1], lags[3 * g + 2]);
    const double length = along.length(), lag = behind.length();
    Imath::Quatd full;
    if (length > 0 && lag > 0 && std::isfinite(lag)) {
      const V3d to = along + behind * std::min(1.0, kMostLag * length / lag);
      full = smallest_turn(along / length, to.normalized());
    }
    for (size_t p = 0; p < segments_; ++p) {
      // A rod under an even load turns most near its root.
      const double s = static_cast<double>(p + 1) / static_cast<double>(segments_), part = s * (2 - s);
      const Imath::Quatd turn = Imath::Quatd(1 - part + full.r * part, full.v * part).normalized();
      for (const double c : {turn.v.x, turn.v.y, turn.v.z, turn.r}) turns.push_back(static_cast<float>(c));
    }
  }
  return turns;
}

}  // namespace pelage
