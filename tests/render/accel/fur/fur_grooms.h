// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "render/accel/accel.h"
#include "tests/render/random.h"

namespace pelage {

/// What a random groom is like. Strands grow near the origin (or `centre`), about one unit long.
struct GroomShape {
  std::string name;
  float width = 0.02f;
  float curl = 0.1f;  ///< radius
  float turns = 1;
  float length = 1;
  V3f centre{0};
  CurveBasis basis = CurveBasis::kPinnedBSpline;
  int motion_keys = 1;
  V3f combed{0};            ///< the direction of all strands, if it is not 0
  bool degenerate = false;  ///< points coincide, widths vanish, strands have no length
};

inline std::vector<GroomShape> groom_shapes() {
  std::vector<GroomShape> shapes(12);
  shapes[0].name = "plain";
  shapes[1].name = "curly", shapes[1].turns = 4, shapes[1].curl = 0.2f;
  shapes[2].name = "tight", shapes[2].turns = 6, shapes[2].curl = 0.02f, shapes[2].width = 0.05f;
  shapes[3].name = "thick", shapes[3].width = 0.3f;
  shapes[4].name = "thin", shapes[4].width = 1e-3f;
  shapes[5].name = "far away", shapes[5].centre = V3f(3000, -20000, 700);
  shapes[6].name = "degenerate", shapes[6].degenerate = true;
  shapes[7].name = "lines", shapes[7].basis = CurveBasis::kLinear;
  shapes[8].name = "through its points", shapes[8].basis = CurveBasis::kCatmullRom, shapes[8].turns = 2;
  shapes[9].name = "moving", shapes[9].motion_keys = 3;
  shapes[10].name = "needles", shapes[10].width = 1e-4f;
  shapes[11].name = "combed", shapes[11].combed = V3f(1, -1, 1).normalized(), shapes[11].curl = 0.02f;
  return shapes;
}

/// Those, and one so far away that floats of the scene have steps of an eighth of a strand: its grid is as
/// cell_bounds as ever, but boxes that stand in the scene hold little but each other.
inline std::vector<GroomShape> groom_shapes_at_any_distance() {
  std::vector<GroomShape> shapes = groom_shapes();
  GroomShape& far = shapes.emplace_back();
  far.name = "very far away", far.centre = V3f(3e5f, -2e6f, 7e4f);
  return shapes;
}

inline Strands random_groom(const GroomShape& shape, size_t strand_count, uint64_t seed) {
  TestRandom random(seed);
  StrandArrays a;
  a.basis = shape.basis;
  a.motion_keys = shape.motion_keys;
  a.first_point.push_back(0);
  std::vector<std::vector<float>> keys(static_cast<size_t>(shape.motion_keys));
  for (uint64_t s = 0; s < strand_count; ++s) {
    const auto points = static_cast<uint32_t>(4 + 8 * random.unit());
    const V3f root = shape.centre + 0.5f * (2.0f * random.unit3() - V3f(1));
    V3f along = random.direction();
    if (shape.combed != V3f(0)) along = (shape.combed + 0.1f * along).normalized();
    const V3f side = along.cross(random.direction()).normalized(), other = along.cross(side);
    const V3f motion = 0.2f * random.direction();
    const float phase = 6.28f * random.unit();
    const float odd = shape.degenerate ? random.unit() : 1;
    for (uint32_t i = 0; i < points; ++i) {
      const float v = static_cast<float>(i) / static_cast<float>(points - 1);
      const float angle = phase + 6.2832f * shape.turns * v;
      V3f p =
          root + (shape.length * v) * along + shape.curl * (std::cos(angle) * side + std::sin(angle) * other);
      float radius = 0.5f * shape.width * (1 - 0.9f * v);
      if (odd < 0.2f) p = root;                                           // no length
      if (odd >= 0.2f && odd < 0.4f && i % 3 != 0) p = root + v * along;  // corners
      if (odd >= 0.4f && odd < 0.6f && i > 1) p = root + 0.05f * side;    // points coincide
      if (odd >= 0.6f && odd < 0.8f && i > 2) radius = 0;                 // no width
      for (int key = 0; key < shape.motion_keys; ++key) {
        const V3f q = p + static_cast<float>(key * key) * motion;
        auto& out = keys[static_cast<size_t>(key)];
        out.insert(out.end(), {q.x, q.y, q.z, radius});
      }
    }
    a.first_point.push_back(a.first_point.back() + points);
    a.ids.push_back(hash64(seed, s) >> 8);
  }
  for (const auto& key : keys) a.points.insert(a.points.end(), key.begin(), key.end());
  return Strands(std::move(a));
}

/// From anywhere within a few units through a point near the strands; every eighth along a strand.
inline Ray ray_at_groom(const GroomShape& shape, const Strands& strands, TestRandom& random, uint64_t index) {
  Ray ray;
  ray.origin = shape.centre + 4.0f * random.unit() * random.direction();
  ray.direction = (shape.centre + 0.7f * (2.0f * random.unit3() - V3f(1)) - ray.origin).normalized();
  if (index % 8 == 0) {
    const auto point = static_cast<size_t>(random.unit() * static_cast<float>(strands.point_count() - 1));
    const V3f along = strands.point(point + 1) - strands.point(point);
    if (along.length() > 1e-6f)
      ray.direction = (along.normalized() + 0.01f * random.direction()).normalized();
    ray.origin = strands.point(point) - 2.0f * random.unit() * ray.direction;
  } else if (index % 8 == 1) {
    const auto point = static_cast<size_t>(random.unit() * static_cast<float>(strands.point_count()));
    ray.direction = (strands.point(point) - ray.origin).normalized();
  }
  if (index % 5 == 0) ray.far = 3 * random.unit();
  if (index % 7 == 0) ray.near = random.unit();
  ray.time = random.unit();
  return ray;
}

}  // namespace pelage
