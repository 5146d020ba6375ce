// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_balls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_map>

#include "base/hash.h"
#include "geom/closest_point.h"
#include "geom/winding.h"

namespace pelage {
namespace {

constexpr uint32_t kEmpty = std::numeric_limits<uint32_t>::max();
/// Approximate number of cells of a skin, as a fraction of its triangles, and its limits. A far character has
/// few triangles, and then few cells.
constexpr double kCellsPerTriangle = 0.5, kMinCells = 64, kMaxCells = 6000;
/// A ball is chosen for points at this height above the skin, in cells.
constexpr float kHeight = 2;
constexpr int kMaxShrinks = 40;
/// Balls are made smaller by this fraction of their radius, and by this fraction of the largest coordinate:
/// more than the rounding errors of clearances, of centers and of ray tests.
constexpr float kMargin = 1e-3f, kBallRounding = 4e-6f;

struct GridCell {
  int64_t x, y, z;
  uint64_t key() const {
    constexpr uint64_t kMask = (uint64_t(1) << 21) - 1;
    return (static_cast<uint64_t>(x) & kMask) | (static_cast<uint64_t>(y) & kMask) << 21 |
           (static_cast<uint64_t>(z) & kMask) << 42;
  }
};

GridCell cell_of(const V3f& at, const V3f& origin, float inverse_size) {
  const auto index = [&](int axis) {
    const float i = std::floor((at[axis] - origin[axis]) * inverse_size);
    return static_cast<int64_t>(std::clamp(i, -1e6f, 1e6f));
  };
  return {index(0), index(1), index(2)};
}

double area_of(const SkinMesh& mesh) {
  double area = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* v = &mesh.triangles[3 * t];
    const V3d a(mesh.position(v[0]));
    area += 0.5 * (V3d(mesh.position(v[1])) - a).cross(V3d(mesh.position(v[2])) - a).length();
  }
  return area;
}

}  // namespace

/// A point of the skin, in a triangle.
struct SkinBalls::Sample {
  uint32_t triangle = 0;
  V3f weights{0};  // barycentric
  float off = 0;   // squared distance from the middle of the cell

  V3f position(const SkinMesh& mesh, int key) const {
    V3f sum(0);
    for (int i = 0; i < 3; ++i)
      sum += weights[i] * mesh.position(mesh.triangles[3 * size_t(triangle) + static_cast<size_t>(i)], key);
    return sum;
  }
  V3f normal(const SkinMesh& mesh, int key) const {
    const uint32_t* v = &mesh.triangles[3 * size_t(triangle)];
    const V3f a = mesh.position(v[0], key);
    return (mesh.position(v[1], key) - a).cross(mesh.position(v[2], key) - a).normalized();
  }
};

struct SkinBalls::Builder {
  Builder(const SkinMesh& skin, const Box3f& box, float size, const Job& job)
      : mesh(skin), cell_size(size), start_radius(0.5f * box.size().length()) {
    for (int key = 0; key < mesh.motion_keys; ++key) {
      trees.emplace_back(mesh, key, &job);
      windings.emplace_back(mesh, key);
    }
    for (int key = 0; key + 1 < mesh.motion_keys; ++key) {
      Box3f moves;
      for (size_t v = 0; v < mesh.vertex_count(); ++v)
        moves.extendBy(mesh.position(v, key + 1) - mesh.position(v, key));
      displacements.push_back(moves);
    }
    for (int axis = 0; axis < 3; ++axis)
      rounding = std::max({rounding, std::abs(box.min[axis]), std::abs(box.max[axis])});
    rounding *= kBallRounding;
  }

  /// Returns one sample per cell, in the order of the keys of cells.
  std::vector<std::pair<uint64_t, Sample>> samples(const V3f& origin) const;
  SkinBall shrink(const V3f& from, const V3f& normal, int key) const;
  float radius(const Sample& sample, std::span<V3f> centers) const;

  const SkinMesh& mesh;
  float cell_size, start_radius, rounding = 0;
  std::vector<ClosestPointTree> trees;   // by motion key
  std::vector<WindingNumbers> windings;  // by motion key
  std::vector<Box3f> displacements;      // of all vertices, from each motion key to the next
};

/// Divides large triangles so that every cell gets a point, and takes the point nearest to its middle.
std::vector<std::pair<uint64_t, SkinBalls::Sample>> SkinBalls::Builder::samples(const V3f& origin) const {
  std::unordered_map<uint64_t, Sample> nearest;
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t* v = &mesh.triangles[3 * size_t(t)];
    const V3f a = mesh.position(v[0]), b = mesh.position(v[1]), c = mesh.position(v[2]);
    if (!((b - a).cross(c - a).length() > 0)) continue;
    const float longest = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
    const int parts = static_cast<int>(std::clamp(std::ceil(longest / cell_size), 1.0f, 512.0f));
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < 2 * (parts - i) - 1; ++j) {
        // The middle of a small triangle: point up where j is even, down where it is odd.
        const float third = j % 2 == 0 ? 1.0f / 3 : 2.0f / 3, n = static_cast<float>(parts);
        const float s = (static_cast<float>(i) + third) / n, u = (static_cast<float>(j / 2) + third) / n;
        Sample sample{t, V3f(1 - s - u, s, u), 0};
        const V3f at = sample.position(mesh, 0);
        const GridCell cell = cell_of(at, origin, 1 / cell_size);
        const V3f middle =
            origin + cell_size * V3f(static_cast<float>(cell.x) + 0.5f, static_cast<float>(cell.y) + 0.5f,
                                     static_cast<float>(cell.z) + 0.5f);
        sample.off = (at - middle).length2();
        const auto [entry, is_new] = nearest.try_emplace(cell.key(), sample);
        if (!is_new && sample.off < entry->second.off) entry->second = sample;
      }
    }
  }
  std::vector<std::pair<uint64_t, Sample>> result(nearest.begin(), nearest.end());
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return result;
}

/// Shrinks a ball with its center on the inner normal [Ma12]. Every center on the way, with its distance from
/// the surface as radius, is an empty ball. Returns the one that hides most directions from a point above the
/// skin, rather than the last one: small bumps of a tessellation would make the last one too small. The first
/// centers may be outside the skin, beyond a limb.
SkinBall SkinBalls::Builder::shrink(const V3f& from, const V3f& normal, int key) const {
  SkinBall best;
  float hidden = 0, radius = start_radius;
  // No smaller ball hides more than one that touches the skin at `from` alone.
  const auto may_hide_more = [&] { return radius > hidden * (radius + kHeight * cell_size); };
  for (int i = 0; i < kMaxShrinks && may_hide_more(); ++i) {
    const V3f center = from - radius * normal;
    ClosestPoint nearest;
    nearest.distance = radius;
    const bool found = trees[static_cast<size_t>(key)].closest_position(center, radius, nearest);
    const float sine = nearest.distance / (radius + kHeight * cell_size);
    if (sine > hidden && windings[static_cast<size_t>(key)].at(center) != 0) {
      hidden = sine;
      best = {center, nearest.distance};
    }
    if (!found || nearest.distance >= radius * (1 - 1e-3f)) break;
    const V3f away = from - nearest.position;
    const float depth = 2 * away.dot(normal);
    const float next = depth > 0 ? away.length2() / depth : 0.5f * radius;
    radius = next < 0.999f * radius ? next : 0.9f * radius;
  }
  return best;
}

/// Computes the center at each motion key, and returns the radius that holds over the whole shutter; 0 or
/// less if there is none.
float SkinBalls::Builder::radius(const Sample& sample, std::span<V3f> centers) const {
  std::vector<float> clear(centers.size());
  float smallest = std::numeric_limits<float>::max();
  for (int key = 0; key < mesh.motion_keys; ++key) {
    const auto k = static_cast<size_t>(key);
    const SkinBall ball = shrink(sample.position(mesh, key), sample.normal(mesh, key), key);
    centers[k] = ball.center;
    clear[k] = ball.radius;
    smallest = std::min(smallest, ball.radius);
  }
  // Relative to the center, no surface point moves farther than `moves` from one key to the next. So the
  // distance from the center to the surface changes at most as fast.
  for (size_t k = 0; k + 1 < clear.size(); ++k) {
    const V3f own = centers[k + 1] - centers[k];
    const Box3f& all = displacements[k];
    V3f farthest;
    for (int axis = 0; axis < 3; ++axis)
      farthest[axis] = std::max(std::abs(all.min[axis] - own[axis]), std::abs(all.max[axis] - own[axis]));
    const float moves = farthest.length();
    smallest = std::min(smallest, 0.5f * (clear[k] + clear[k + 1] - moves));
  }
  const float radius = smallest * (1 - kMargin) - rounding;
  return radius > 0 ? radius : 0.0f;
}

SkinBalls::SkinBalls(const SkinMesh& mesh, const Job& job) : keys_(mesh.motion_keys) {
  if (!is_closed(mesh)) return;
  Box3f open;
  for (int key = 0; key < keys_; ++key) {
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      bounds_.extendBy(mesh.position(v, key));
      if (key == 0) open.extendBy(mesh.position(v, 0));
    }
  }
  const double cells =
      std::clamp(kCellsPerTriangle * static_cast<double>(mesh.triangle_count()), kMinCells, kMaxCells);
  const auto size = static_cast<float>(std::sqrt(area_of(mesh) / cells));
  if (!(size > 0) || !std::isfinite(size)) return;
  origin_ = open.min;
  inverse_size_ = 1 / size;

  const Builder builder(mesh, bounds_, size, job);
  const auto samples = builder.samples(origin_);
  const auto keys = static_cast<size_t>(keys_);
  std::vector<V3f> centers(samples.size() * keys);
  std::vector<float> radii(samples.size());
  job.for_each(samples.size(), 64, [&](WorkRange range) {
    for (size_t i = range.begin; i < range.end; ++i)
      radii[i] = builder.radius(samples[i].second, std::span(centers).subspan(i * keys, keys));
  });
  const auto made =
      static_cast<size_t>(std::count_if(radii.begin(), radii.end(), [](float r) { return r > 0; }));
  size_t slots = 16;
  while (slots < 2 * made) slots *= 2;
  slots_.assign(slots, 0);
  indices_.assign(slots, kEmpty);
  centers_.reserve(made * keys);
  radii_.reserve(made);
  places_.reserve(made);
  for (size_t i = 0; i < samples.size(); ++i) {
    if (!(radii[i] > 0)) continue;
    insert(samples[i].first, static_cast<uint32_t>(radii_.size()));
    radii_.push_back(radii[i]);
    places_.push_back(samples[i].second.position(mesh, 0));
    for (size_t k = 0; k < keys; ++k) centers_.push_back(centers[i * keys + k]);
  }
}

uint32_t SkinBalls::slot_of(uint64_t key) const {
  const size_t mask = slots_.size() - 1;
  size_t slot = mix64(key) & mask;
  while (indices_[slot] != kEmpty && slots_[slot] != key) slot = (slot + 1) & mask;
  return static_cast<uint32_t>(slot);
}

void SkinBalls::insert(uint64_t key, uint32_t ball) {
  const uint32_t slot = slot_of(key);
  slots_[slot] = key;
  indices_[slot] = ball;
}

std::optional<uint32_t> SkinBalls::find(const V3f& at_open) const {
  if (radii_.empty()) return {};
  const GridCell cell = cell_of(at_open, origin_, inverse_size_);
  const uint32_t own = indices_[slot_of(cell.key())];
  if (own != kEmpty) return own;
  uint32_t nearest = kEmpty;
  float best = std::numeric_limits<float>::max();
  for (int i = 0; i < 27; ++i) {
    const GridCell beside{cell.x + i % 3 - 1, cell.y + i / 3 % 3 - 1, cell.z + i / 9 - 1};
    const uint32_t ball = indices_[slot_of(beside.key())];
    if (ball == kEmpty) continue;
    const float distance = (places_[ball] - at_open).length2();
    if (distance < best) {
      best = distance;
      nearest = ball;
    }
  }
  return nearest == kEmpty ? std::nullopt : std::optional(nearest);
}

SkinBall SkinBalls::ball(uint32_t index, float time) const {
  const V3f* centers = &centers_[size_t(index) * static_cast<size_t>(keys_)];
  if (keys_ == 1) return {centers[0], radii_[index]};
  const float scaled = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(keys_ - 1);
  const int key = std::min(static_cast<int>(scaled), keys_ - 2);
  const float t = scaled - static_cast<float>(key);
  return {(1 - t) * centers[key] + t * centers[key + 1], radii_[index]};
}

size_t SkinBalls::bytes() const {
  return sizeof(*this) + centers_.capacity() * sizeof(V3f) + radii_.capacity() * sizeof(float) +
         places_.capacity() * sizeof(V3f) + slots_.capacity() * sizeof(uint64_t) +
         indices_.capacity() * sizeof(uint32_t);
}

size_t SkinBalls::temporary_bytes(const SkinMesh& mesh) {
  // Per triangle: a tree and the columns of WindingNumbers for each motion key, building the last tree, edges
  // of is_closed().
  const size_t per_triangle = (100 + 56) * static_cast<size_t>(mesh.motion_keys) + 28 + 36;
  return mesh.triangle_count() * per_triangle + static_cast<size_t>(4 * kMaxCells) * 128;
}

}  // namespace pelage
