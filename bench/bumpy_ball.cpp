// SPDX-License-Identifier: Apache-2.0
#include "bench/bumpy_ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/hash.h"

namespace pelage {
namespace {

constexpr float kPiFloat = std::numbers::pi_v<float>;
constexpr int kPoints = 8;
constexpr size_t kClumps = 2500;

/// A few plane waves per component: smooth, isotropic enough, and the same everywhere.
V3f smooth_noise(const V3f& p, float frequency, uint64_t seed) {
  V3f sum(0);
  for (uint64_t wave = 0; wave < 6; ++wave) {
    for (uint64_t axis = 0; axis < 3; ++axis) {
      const auto random = [&](uint64_t i) { return signed_float(hash64(seed, wave, axis, i)); };
      const V3f direction(random(0), random(1), random(2));
      sum[static_cast<int>(axis)] += std::sin(frequency * 2.5f * direction.dot(p) + kPiFloat * random(3));
    }
  }
  return sum / 3.0f;
}

V3f surface_point(const V3f& direction) {
  const float bump = 1 + 0.06f * std::sin(7 * direction.x + 1) * std::sin(6 * direction.y) +
                     0.05f * std::sin(9 * direction.z + 5 * direction.x);
  return {direction.x * bump * 1.05f, direction.y * bump * 0.95f, direction.z * bump};
}

V3f surface_normal(const V3f& direction) {
  const V3f helper = std::abs(direction.x) < 0.6f ? V3f(1, 0, 0) : V3f(0, 1, 0);
  const V3f a = direction.cross(helper).normalized();
  const V3f b = direction.cross(a);
  const float step = 1e-3f;
  const V3f du = surface_point((direction + step * a).normalized()) - surface_point(direction);
  const V3f dv = surface_point((direction + step * b).normalized()) - surface_point(direction);
  const V3f n = du.cross(dv).normalized();
  return n.dot(direction) < 0 ? -n : n;
}

V3f random_direction(uint64_t seed, uint64_t index, uint64_t use) {
  const float z = signed_float(hash64(seed, index, use, 0));
  const float phi = 2 * kPiFloat * unit_float(hash64(seed, index, use, 1));
  const float s = std::sqrt(std::max(0.0f, 1 - z * z));
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// Points of one strand, uncombed into clumps.
void grow(uint64_t seed, uint64_t index, V3f* points) {
  const V3f direction = random_direction(seed, index, random_use("root"));
  const V3f root = surface_point(direction);
  const V3f wild = random_direction(seed, index, random_use("wild"));
  const V3f along =
      (surface_normal(direction) + 0.45f * smooth_noise(root, 1.2f, seed) + 0.18f * wild).normalized();
  const float length = 0.30f * (0.75f + 0.5f * unit_float(hash64(seed, index, random_use("length"))));
  for (int k = 0; k < kPoints; ++k) {
    const float v = static_cast<float>(k) / (kPoints - 1);
    const V3f frizz = smooth_noise(
        V3f(static_cast<float>(index % 4096), 12 * v, static_cast<float>(index / 4096)), 1.0f, seed + 7);
    points[k] = root + v * length * along + V3f(0, -0.13f * v * v, 0) + 0.02f * v * frizz;
  }
}

/// Clump centres in a grid over [-1.6, 1.6]^3 by the cell of their roots.
class ClumpGrid {
 public:
  explicit ClumpGrid(uint64_t seed) {
    for (size_t i = 0; i < kClumps; ++i) {
      roots_.push_back(surface_point(random_direction(seed, kOffset + i, random_use("root"))));
      cells_[cell(roots_.back())].push_back(i);
    }
  }
  uint64_t nearest(const V3f& p) const {
    uint64_t best = 0;
    float best_distance = 1e30f;
    const int x = coordinate(p.x), y = coordinate(p.y), z = coordinate(p.z);
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          for (size_t i : cells_[index(x + dx, y + dy, z + dz)]) {
            const float d = (roots_[i] - p).length2();
            if (d < best_distance) {
              best_distance = d;
              best = i;
            }
          }
        }
      }
    }
    return kOffset + best;
  }

  static constexpr uint64_t kOffset = uint64_t(1) << 40;  // centres are strands of their own

 private:
  static constexpr int kSide = 24;
  static int coordinate(float x) {
    return std::clamp(static_cast<int>((x + 1.6f) / 3.2f * kSide), 1, kSide - 2);
  }
  static size_t index(int x, int y, int z) { return static_cast<size_t>((z * kSide + y) * kSide + x); }
  static size_t cell(const V3f& p) { return index(coordinate(p.x), coordinate(p.y), coordinate(p.z)); }

  std::vector<V3f> roots_;
  std::vector<std::vector<size_t>> cells_ = std::vector<std::vector<size_t>>(kSide * kSide * kSide);
};

SkinMesh make_skin(float motion) {
  constexpr uint32_t kRows = 96, kColumns = 192;
  SkinMesh mesh;
  mesh.motion_keys = motion != 0 ? 2 : 1;
  for (int key = 0; key < mesh.motion_keys; ++key) {
    for (uint32_t i = 0; i <= kRows; ++i) {
      for (uint32_t j = 0; j < kColumns; ++j) {
        const float theta = kPiFloat * static_cast<float>(i) / kRows;
        const float phi = 2 * kPiFloat * static_cast<float>(j) / kColumns;
        const V3f d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        const V3f p = surface_point(d) + V3f(motion * static_cast<float>(key), 0, 0);
        const V3f n = surface_normal(d);
        mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
        mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
      }
    }
  }
  for (uint32_t i = 0; i < kRows; ++i) {
    for (uint32_t j = 0; j < kColumns; ++j) {
      const uint32_t a = i * kColumns + j, b = i * kColumns + (j + 1) % kColumns;
      const uint32_t c = a + kColumns, d = b + kColumns;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, c, b, d, c});
    }
  }
  mesh.faces.assign(mesh.triangle_count(), 0);
  mesh.vertex_uv.assign(mesh.triangles.size(), V2f(0.5f));
  return mesh;
}

}  // namespace

BumpyBall make_bumpy_ball(size_t strand_count, uint64_t seed, float motion) {
  const ClumpGrid clumps(seed);
  const float radius = 0.0011f * std::sqrt(1e5f / static_cast<float>(strand_count));
  StrandArrays a;
  a.motion_keys = motion != 0 ? 2 : 1;
  a.first_point.push_back(0);
  V3f points[kPoints], centre[kPoints];
  for (uint64_t i = 0; i < strand_count; ++i) {
    grow(seed, i, points);
    grow(seed, clumps.nearest(points[0]), centre);
    for (int k = 0; k < kPoints; ++k) {
      const float v = static_cast<float>(k) / (kPoints - 1);
      const V3f p = points[k] + 0.65f * v * (centre[k] - points[k]);
      const float r = radius * (1 - 0.85f * v);
      a.points.insert(a.points.end(), {p.x, p.y, p.z, r});
    }
    a.first_point.push_back(static_cast<uint32_t>((i + 1) * kPoints));
    a.ids.push_back(i);
  }
  if (motion != 0) {
    const size_t one_key = a.points.size();
    a.points.resize(2 * one_key);
    for (size_t i = 0; i < one_key; ++i) a.points[one_key + i] = a.points[i] + (i % 4 == 0 ? motion : 0);
  }
  return {Strands(std::move(a)), make_skin(motion)};
}

}  // namespace pelage
