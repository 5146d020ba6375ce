// SPDX-License-Identifier: Apache-2.0
#include "render/frame/skin_point.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

/// A triangle of a sphere about the origin, with the normals of the sphere or all alike.
SkinMesh triangle_of_sphere(float radius, bool flat) {
  SkinMesh mesh;
  const V3f middle = V3f(0.3f, 0.5f, 1).normalized();
  for (const V3f& corner : {V3f(0, 0.1f, 0), V3f(0.08f, -0.05f, 0), V3f(-0.07f, -0.04f, 0.02f)}) {
    const V3f n = (middle + corner).normalized();
    for (const float x : {n.x, n.y, n.z}) mesh.positions.push_back(radius * x);
    const V3f shown = flat ? middle : n;
    for (const float x : {shown.x, shown.y, shown.z}) mesh.normals.push_back(x);
  }
  mesh.triangles = {0, 1, 2};
  mesh.faces = {0};
  return mesh;
}

TEST(SkinRise, IsThatOfASphere) {
  const float radius = 3;
  const SkinMesh mesh = triangle_of_sphere(radius, false);
  const V3f normal = V3f(0.3f, 0.5f, 1).normalized();
  const V3f u = normal.cross(V3f(1, 0, 0)).normalized(), v = normal.cross(u);
  for (const V3f& away : {0.3f * u, -0.5f * v, 0.2f * u + 0.4f * v}) {
    const float below = away.length2() / (2 * radius);
    EXPECT_NEAR(skin_rise(mesh, 0, normal, away), -below, 0.02f * below);
    EXPECT_NEAR(skin_rise(mesh, 0, -normal, away), below, 0.02f * below);  // a bowl, from inside
  }
  EXPECT_EQ(skin_rise(mesh, 0, normal, V3f(0)), 0);
}

TEST(SkinRise, IsNoMoreThanTheWay) {
  const SkinMesh mesh = triangle_of_sphere(0.01f, false);
  const V3f normal = V3f(0.3f, 0.5f, 1).normalized(), away = normal.cross(V3f(5, 0, 0));
  EXPECT_EQ(skin_rise(mesh, 0, normal, away), -away.length());
}

TEST(SkinRise, IsNoneOfAPlane) {
  const V3f normal = V3f(0.3f, 0.5f, 1).normalized();
  EXPECT_EQ(skin_rise(triangle_of_sphere(3, true), 0, normal, normal.cross(V3f(1, 0, 0))), 0);
  SkinMesh point;  // a triangle without area
  point.positions.assign(9, 1);
  for (int c = 0; c < 3; ++c) point.normals.insert(point.normals.end(), {0, 0, 1});
  EXPECT_EQ(skin_rise(point, 0, V3f(0, 0, 1), V3f(1, 0, 0)), 0);
}

}  // namespace
}  // namespace pelage
