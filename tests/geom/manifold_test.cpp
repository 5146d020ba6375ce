// SPDX-License-Identifier: Apache-2.0
#include "geom/manifold.h"

#include <gtest/gtest.h>

#include "geom/cage_refiner.h"
#include "tests/geom/surface_cages.h"

namespace pelage {
namespace {

/// One letter for each vertex.
std::string fans(const ControlMesh& mesh) {
  std::string text;
  for (const VertexFan fan : vertex_fans(mesh)) text += "cot"[static_cast<int>(fan)];
  return text;
}
std::string fans(size_t vertices, const std::vector<std::vector<uint32_t>>& faces) {
  return fans(make_cage(std::vector<V3f>(vertices), faces));
}

TEST(VertexFans, AreClosedOpenOrTangled) {
  EXPECT_EQ(fans(cube_cage()), "cccccccc");
  EXPECT_EQ(fans(grid_cage(2, 2)),
            "ooooc"
            "oooo");
  EXPECT_EQ(fans(4, {{0, 1, 2}}), "oooo") << "no face";
  EXPECT_EQ(fans(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), "ttooo") << "three faces at an edge";
  EXPECT_EQ(fans(4, {{0, 1, 2}, {0, 1, 3}}), "ttoo") << "two faces in the same direction";
  EXPECT_EQ(fans(5, {{0, 1, 2}, {0, 3, 4}}), "toooo") << "two open fans";
  EXPECT_EQ(fans(7, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}}), "toooooo")
      << "two closed fans";
  EXPECT_EQ(fans(4, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {0, 3, 1}})[0], 't') << "a face twice";
  EXPECT_EQ(fans(3, {{0, 1, 1, 2}})[1], 't') << "a vertex beside itself";
  EXPECT_EQ(fans(3, {{0, 1, 9}, {7, 8, 9}}).substr(0, 2), "oo") << "vertices that do not exist";
}

/// OpenSubdiv finds the same vertices tangled, apart from those without faces: it refines around them.
TEST(VertexFans, AreManifoldForOpenSubdivToo) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<std::vector<uint32_t>> faces;
    for (uint64_t f = 0; f < 3 + seed % 9; ++f) {
      std::vector<uint32_t> face;
      for (uint64_t i = 0; face.size() < 3 + hash64(seed, f) % 2; ++i) {
        const auto v = static_cast<uint32_t>(hash64(seed, f, i) % 8);
        if (std::find(face.begin(), face.end(), v) == face.end()) face.push_back(v);
      }
      faces.push_back(face);
    }
    const ControlMesh mesh = make_cage(std::vector<V3f>(8), faces);
    const auto refiner = make_refiner(mesh, kCatmull, kCorners, "test");
    const std::vector<VertexFan> fans = vertex_fans(mesh);
    for (int v = 0; v < 8; ++v) {
      if (refiner->GetLevel(0).GetVertexFaces(v).empty()) continue;
      EXPECT_EQ(refiner->GetLevel(0).IsVertexNonManifold(v),
                fans[static_cast<size_t>(v)] == VertexFan::kTangled)
          << "seed " << seed << ", vertex " << v;
    }
  }
}

}  // namespace
}  // namespace pelage
