// SPDX-License-Identifier: Apache-2.0
#include "geom/surface_motion.h"

#include <gtest/gtest.h>

#include "tests/geom/surface_cages.h"

namespace pelage::cage_point_test {
namespace {

LimitSurface smooth(const ControlMesh& cage, SubdivisionScheme scheme = kCatmull) {
  return {SurfaceTopology::create(cage, scheme, kCorners, "test"), cage.positions};
}

auto of(const std::vector<V3f>& positions) {
  return [&](uint32_t vertex) { return positions[vertex]; };
}

template <class Visit>
void visit_points(const SurfaceTopology& topology, const Visit& visit) {
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    for (const V2f& at : {V2f(0, 0), V2f(0.25f, 0.5f), V2f(0.75f, 0.125f)}) visit(face, at.x, at.y);
  }
}

// The limit surfaces of these schemes are the cage.
TEST(CagePoint, IsThatOfSurfacesWithoutRounding) {
  for (const SubdivisionScheme scheme : {SubdivisionScheme::kBilinear, SubdivisionScheme::kNone}) {
    const ControlMesh cage = prism_cage(5);
    const LimitSurface surface = smooth(cage, scheme);
    visit_points(surface.topology(), [&](uint32_t face, float u, float v) {
      const SurfacePoint expected = surface.evaluate(face, u, v);
      const SurfacePoint point = cage_point(surface.topology(), face, u, v, of(cage.positions));
      EXPECT_LT((point.position - expected.position).length(), 1e-5f);
      EXPECT_LT((point.du - expected.du).length() + (point.dv - expected.dv).length(), 1e-4f);
    });
  }
}

TEST(SurfaceStep, MovesPointsFarFromACoarseCageExactly) {
  const ControlMesh cage = shaken(prism_cage(5));
  const M44f motion = M44f().setEulerAngles(V3f(0.3f, -0.7f, 1.1f)) * M44f().setTranslation(V3f(5, -3, 2));
  const LimitSurface surface = smooth(cage);
  for (const float scale : {1.0f, 3.0f}) {
    std::vector<V3f> next = cage.positions;
    for (V3f& p : next) p = p * scale * motion;
    visit_points(surface.topology(), [&](uint32_t face, float u, float v) {
      const SurfaceStep step{cage_point(surface.topology(), face, u, v, of(cage.positions)),
                             cage_point(surface.topology(), face, u, v, of(next))};
      const V3f root = surface.evaluate(face, u, v).position, tip = root + V3f(0.5f, 0.25f, -0.25f);
      EXPECT_LT((step.moved(root) - root * scale * motion).length(), 1e-4f);
      // A strand turns with the surface and keeps its length.
      V3f turned;
      motion.multDirMatrix(tip - root, turned);
      EXPECT_LT((step.moved(tip, root) - (root * scale * motion + turned)).length(), 1e-4f);
    });
  }
}

}  // namespace
}  // namespace pelage::cage_point_test
