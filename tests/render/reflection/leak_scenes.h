// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geom/limit_surface.h"
#include "geom/mesh.h"
#include "image/exr.h"
#include "tests/render/path/path_scene.h"

namespace pelage {

/// A skin of flat plates, each a face of the rest surface, and straight hair that grows on them.
class Plates {
 public:
  /// Adds the parallelogram with the corner `at` and the edges `u` and `v`. It faces u x v.
  uint32_t add(const V3f& at, const V3f& u, const V3f& v) {
    const auto first = static_cast<uint32_t>(cage_.positions.size());
    const V3f normal = u.cross(v).normalized();
    const V2f places[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const V2f& place : places) {
      const V3f p = at + place.x * u + place.y * v;
      cage_.face_vertices.push_back(static_cast<uint32_t>(cage_.positions.size()));
      cage_.positions.push_back(p);
      mesh_.positions.insert(mesh_.positions.end(), {p.x, p.y, p.z});
      mesh_.normals.insert(mesh_.normals.end(), {normal.x, normal.y, normal.z});
    }
    const auto face = static_cast<uint32_t>(cage_.face_sizes.size());
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
      mesh_.triangles.push_back(first + i);
      mesh_.vertex_uv.push_back(places[i]);
    }
    mesh_.faces.insert(mesh_.faces.end(), {face, face});
    cage_.face_sizes.push_back(4);
    cage_.face_groups.push_back(0);
    return face;
  }
  /// Adds the six sides of a box, which face outwards.
  void add_box(const V3f& low, const V3f& high) {
    const V3f size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    add(low, z, y);      // left
    add(low + x, y, z);  // right
    add(low, x, z);      // bottom
    add(low + y, z, x);  // top
    add(low, y, x);      // back
    add(low + z, x, y);  // front
  }
  /// Adds hair to the part [low, high] of a face.
  void grow(StrandArrays& hair, uint32_t face, int count, float length, float radius, V2f low = V2f(0),
            V2f high = V2f(1)) const {
    if (hair.first_point.empty()) hair.first_point = {0};
    const V3f* corner = &cage_.positions[4 * face];
    const V3f u = corner[1] - corner[0], v = corner[3] - corner[0], up = u.cross(v).normalized();
    for (int i = 0; i < count; ++i) {
      const auto id = static_cast<uint32_t>(hair.ids.size());
      SampleStream stream(23, id, face, 0);
      const V2f random = stream.next2d();
      const V2f at(low.x + random.x * (high.x - low.x), low.y + random.y * (high.y - low.y));
      const V3f along = (up + 0.3f * uniform_direction(stream.next2d())).normalized();
      for (int k = 0; k < 4; ++k) {
        const V3f p = corner[0] + at.x * u + at.y * v + (length * static_cast<float>(k) / 3) * along;
        hair.points.insert(hair.points.end(), {p.x, p.y, p.z, radius});
      }
      hair.first_point.push_back(static_cast<uint32_t>(hair.points.size() / 4));
      hair.ids.push_back(id);
      hair.roots.push_back({face, at.x, at.y});
      hair.root_uv.push_back(at);
    }
  }
  const SkinMesh& mesh() const { return mesh_; }
  std::shared_ptr<const LimitSurface> rest() const {
    ControlMesh cage = cage_;
    cage.groups = {""};
    return std::make_shared<const LimitSurface>(
        SurfaceTopology::create(cage, SubdivisionScheme::kBilinear, BoundaryRule::kEdgeAndCorner, "plates"),
        cage.positions);
  }

 private:
  ControlMesh cage_;
  SkinMesh mesh_;
};

/// A small picture of a lit and a dark region that touch. Where the cells of the reflection cache or the
/// patches of PathSharing join them, light leaks into the dark one.
struct LeakScene : PathScene {
  static constexpr int kSide = 48;

  LeakScene() : PathScene(kSide, kSide) {
    image.filter_samples = FilterSamples::kSplatted;
    render.samples = 16;
    render.bounces = 8;
    render.gather.cache_paths = 1;
  }
  void add_plates(const Plates& plates, const Rgb& color) {
    LambertParams hide;
    hide.color = Field(color);
    add_skin(plates.mesh(), hide);
    skins.back().rest = plates.rest();
  }
  void add_hair(const Plates& plates, StrandArrays hair, const Rgb& color) {
    ChiangParams fibre;
    fibre.color = Field(color);
    add_hair(plates, std::move(hair), fibre);
  }
  void add_hair(const Plates& plates, StrandArrays hair, const MaterialParams& fibre) {
    add_fur(Strands(std::move(hair)), fibre);
    fur.back().rest = plates.rest();
  }
  void add_lamp(const V3f& position, float radiance) {
    RectangleLightParams lamp;
    lamp.position = position;
    lamp.look_at = V3f(0);
    lamp.size = V2f(2, 2);
    lamp.radiance = Rgb(radiance);
    add_light("lamp", lamp);
  }

  PixelBox lit;   ///< a region of the picture that is lit
  PixelBox dark;  ///< more than eight pixels from the lit region along the skin or the strands
};

/// A closed ear, a pixel thick, seen from its edge. Pale fur on both sides; the light is on the left. Both
/// sides lie in the same cube of the skin at rest.
struct ThinEar : LeakScene {
  ThinEar() {
    Plates ear;
    ear.add_box(V3f(0.09f, -1, -1), V3f(0.13f, 1, 1));
    StrandArrays hair;
    for (const uint32_t face : {0u, 1u}) ear.grow(hair, face, 1500, 0.5f, 0.012f);
    add_plates(ear, Rgb(0.6f));
    add_hair(ear, std::move(hair), Rgb(0.85f));
    add_lamp(V3f(-5, 0, 0), 5);
    add_sky(Rgb(0.01f));
    camera.fov = 12;
    lit = {15, 4, 25, 44};
    dark = {28, 4, 37, 44};
  }
};

/// Hair that grows on the floor of a dark room, and through its roof. The room is open towards the camera;
/// the light comes from above and behind.
struct HairThroughSkin : LeakScene {
  HairThroughSkin() {
    Plates room;
    const V3f x(2, 0, 0), y(0, 1, 0), z(0, 0, 1), corner(-1, -0.9f, -0.5f);
    room.add(corner, z, x);      // floor
    room.add(corner + y, z, x);  // roof
    room.add(corner, x, y);      // back wall
    room.add(corner, y, z);      // left wall
    room.add(corner + x, z, y);  // right wall
    StrandArrays hair;
    room.grow(hair, 0, 400, 1.7f, 0.012f);
    add_plates(room, Rgb(0.8f));
    add_hair(room, std::move(hair), Rgb(0.85f));
    add_lamp(V3f(0, 4, -3), 5);
    add_sky(Rgb(0.01f));
    camera.fov = 12;
    lit = {2, 9, 46, 20};
    dark = {2, 32, 46, 44};
  }
};

/// A black and a white coat on one skin: black on the left, white on the right, both in the middle.
struct TwoCoats : LeakScene {
  TwoCoats() {
    Plates skin;
    skin.add(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0));
    StrandArrays black, white;
    skin.grow(black, 0, 1800, 0.3f, 0.012f, V2f(0), V2f(0.65f, 1));
    skin.grow(white, 0, 1800, 0.3f, 0.012f, V2f(0.35f, 0), V2f(1));
    add_plates(skin, Rgb(0.3f));
    add_hair(skin, std::move(black), Rgb(0.01f));
    add_hair(skin, std::move(white), Rgb(0.9f));
    add_lamp(V3f(1, 3, 4), 2.5f);
    add_sky(Rgb(0.2f));
    camera.fov = 10;
    lit = {36, 2, 46, 46};
    dark = {2, 2, 21, 46};
  }
};

/// Hair on a block, and at the bottom of a deep hole in it. The light grazes the block.
struct StrandInAHole : LeakScene {
  StrandInAHole() {
    Plates block;
    constexpr float kHalf = 0.3f, kDeep = 1.2f;
    const V3f side(2, 0, 0), across(0, 2, 0);
    const uint32_t left = block.add(V3f(-1, -1, 0), V3f(1 - kHalf, 0, 0), across);
    const uint32_t right = block.add(V3f(kHalf, -1, 0), V3f(1 - kHalf, 0, 0), across);
    const uint32_t below = block.add(V3f(-kHalf, -1, 0), V3f(2 * kHalf, 0, 0), V3f(0, 1 - kHalf, 0));
    const uint32_t above = block.add(V3f(-kHalf, kHalf, 0), V3f(2 * kHalf, 0, 0), V3f(0, 1 - kHalf, 0));
    const V3f corner(-kHalf, -kHalf, -kDeep), x(2 * kHalf, 0, 0), y(0, 2 * kHalf, 0), z(0, 0, kDeep);
    const uint32_t bottom = block.add(corner, x, y);
    block.add(corner, y, z);
    block.add(corner + x, z, y);
    block.add(corner, z, x);
    block.add(corner + y, x, z);
    StrandArrays hair;
    for (const uint32_t face : {left, right}) block.grow(hair, face, 600, 0.2f, 0.012f);
    for (const uint32_t face : {below, above}) block.grow(hair, face, 180, 0.2f, 0.012f);
    block.grow(hair, bottom, 150, 0.4f, 0.012f);
    add_plates(block, Rgb(0.2f));
    add_hair(block, std::move(hair), diffuse_fibre(Rgb(0.5f)));
    add_lamp(V3f(-6, 0, 0.8f), 10);
    add_sky(Rgb(0.01f));
    camera.fov = 8;
    lit = {2, 4, 10, 44};
    dark = {18, 18, 30, 30};
  }
};

}  // namespace pelage
