// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/quiet_job.h"
#include "tests/world/small_scene.h"
#include "world/compose.h"

namespace pelage {

/// Two characters with coats of many leaves: a cube that moves with its poses, and a still one.
class FurryScene : public SmallScene {
 public:
  FurryScene() {
    write("fur.yaml", R"(pelage: 1
camera: {position: [3, 2, 8], look_at: [1, 0, 0], fov: 40, shutter: [-0.25, 0.25], motion_keys: 3}
image: {width: 48, height: 32}
skins:
  cube: {mesh: cube.obj, poses: {files: "cube.%04d.obj", first: 1, count: 3}}
  still: {mesh: cube.obj, scheme: none}
grooms:
  coat:
    skin: cube
    strands: 900
    points: 5
    leaf_strands: 50
    operators: [{length: {value: 0.4, variation: 0.3}}, {color: {value: [0.5, 0.3, 0.2], variation: 0.3}}, {width: {root: 0.02, tip: 0.005}}]
  whiskers: {skin: still, strands: 30, points: 4, role: whisker, operators: [{length: {value: 0.5}}, {width: {root: 0.01, tip: 0.01}}]}
materials:
  hide: {model: lambert, color: 0.4}
  fur: {model: cone-shell, color: {attribute: color}, diffuse: 0.7, primary: [0.1, 0.2, 0.3]}
characters:
  walker: {parts: [{skin: cube, material: hide, grooms: {coat: fur}}], transform: {scale: 2, translate: [0, 1, 0]}}
  post: {parts: [{skin: still, material: hide, grooms: {whiskers: fur}}]}
lights:
  key: {type: rectangle, position: [5, 8, 5], look_at: [0, 0, 0], size: [2, 1], radiance: [1, 2, 3], intensity: 3}
  ball: {type: sphere, position: [-5, 2, 1], radius: 0.5}
  sky: {type: environment, radiance: 0.3}
render: {samples: 6, bounces: 2, lod: {enabled: false}}
)");
  }
  std::string scene() const { return path("fur.yaml"); }
};

/// Makes the scene one that can be rendered: its whiskers lack the attribute `color` that its fur reads.
inline const Override kColor{"materials.fur.color", "[0.5, 0.3, 0.2]"};

/// A strand as the picture has it, to compare strands from different sources.
struct ComparedStrand {
  std::vector<float> points;  ///< x, y, z, radius of all keys
  bool operator==(const ComparedStrand&) const = default;
};
using StrandsById = std::map<uint64_t, ComparedStrand>;

inline void add_strands(const Strands& strands, StrandsById& out) {
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    ComparedStrand one;
    for (int key = 0; key < strands.motion_keys(); ++key) {
      const auto points = strands.points(key).subspan(4 * size_t(strands.first_point(s)),
                                                      4 * size_t(strands.strand_points(s)));
      one.points.insert(one.points.end(), points.begin(), points.end());
    }
    EXPECT_TRUE(out.emplace(strands.id(s), std::move(one)).second) << "id " << strands.id(s) << " twice";
  }
}

/// The strands of a coat that a picture of the scene shows: the reference of all other ways.
inline StrandsById picture_strands(const std::string& scene_path, const std::string& coat, int frame,
                                   const std::vector<Override>& overrides = {}) {
  QuietJob job;
  const SceneDescription scene = load_scene(scene_path, overrides);
  const auto assets = load_assets(scene, job);
  const World world = compose(scene, *assets, frame, job);
  StrandsById strands;
  for (const FurPart& part : world.scene.fur) {
    if (part.name != coat) continue;
    for (const auto& procedural : part.procedurals) {
      for (const auto& leaf : procedural->split()) add_strands(leaf->generate(), strands);
    }
  }
  return strands;
}

}  // namespace pelage
