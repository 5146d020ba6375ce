// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "base/temporary_folder.h"

namespace pelage {

/// A furry cube that walks along x, one unit per frame, with two poses and everything a scene needs, in a
/// folder of its own.
class SmallScene {
 public:
  /// `maps`: whether the cube has texture coordinates.
  explicit SmallScene(bool maps = false) {
    write("cube.obj", cube(0, maps));
    for (int pose = 1; pose <= 3; ++pose)
      write("cube.000" + std::to_string(pose) + ".obj", cube(static_cast<float>(pose)));
    write("scene.yaml", R"(pelage: 1
camera: {position: [3, 2, 8], look_at: [1, 0, 0], fov: 40, shutter: [-0.25, 0.25]}
image: {width: 24, height: 16}
skins:
  cube: {mesh: cube.obj, poses: {files: "cube.%04d.obj", first: 1, count: 3}}
  still: {mesh: cube.obj}
grooms:
  coat:
    skin: cube
    strands: 400
    points: 5
    operators: [{length: {value: 0.4}}, {push_out: {}}, {width: {root: 0.02, tip: 0.005}}]
materials:
  hide: {model: lambert, color: 0.4}
  fur: {model: cone-shell, color: [0.6, 0.4, 0.2], diffuse: 0.7}
characters:
  walker: {parts: [{skin: cube, material: hide, grooms: {coat: fur}}], transform: {scale: 2, translate: [0, 1, 0]}}
  post: {parts: [{skin: still, material: hide}]}
lights:
  key: {type: sphere, position: [5, 8, 5], radius: 1, intensity: 30}
  sky: {type: environment, radiance: 0.3}
render: {samples: 4, bounces: 2, lod: {enabled: false}}
)");
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

 private:
  // A cube of side 1 centred at x.
  static std::string cube(float x, bool maps = false) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      text += "v " + std::to_string(x + ((i & 1) ? 0.5f : -0.5f)) + ((i & 2) ? " 0.5" : " -0.5") +
              ((i & 4) ? " 0.5" : " -0.5") + "\n";
    }
    if (maps) {
      return text +
             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\nf 1/1 2/2 6/3 5/4\n" +
             "f 3/1 7/2 8/3 4/4\nf 1/1 5/2 7/3 3/4\nf 2/1 4/2 8/3 6/4\n";
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }

  TemporaryFolder folder_;
};

}  // namespace pelage
