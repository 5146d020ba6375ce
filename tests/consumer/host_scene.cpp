// SPDX-License-Identifier: Apache-2.0
// A host without files: its mesh is in memory, it grows strands into arrays, and it sees the picture form.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>

#include "base/stop_switch.h"
#include "base/version.h"
#include "geom/io/host_geometry.h"
#include "image/host_image.h"
#include "render/frame/frame_watch.h"
#include "world/scene_session.h"

namespace {

constexpr const char* kScene = R"(
pelage: 1
camera: {position: [0, 2, 4], look_at: [0, 0, 0], fov: 40}
image: {width: 32, height: 18}
skins: {ground: {mesh: from-memory, scheme: none}}
grooms: {grass: {skin: ground, strands: 500, points: 4, density: {map: from-memory, channel: r, projection: planar, axis: y},
                 operators: [{length: {value: 0.3}}, {width: {root: 0.05}}]}}
materials: {earth: {model: lambert}, blade: {model: chiang}}
characters: {lawn: {parts: [{skin: ground, material: earth, grooms: {grass: blade}}]}}
lights: {sun: {type: rectangle, position: [2, 4, 3], look_at: [0, 0, 0], size: [2, 2], radiance: [5, 5, 5]}}
render: {samples: 4}
)";

class Passes final : public pelage::FrameWatch {
 public:
  void passed(const pelage::Film& film, const pelage::PassState&) override {
    ++count;
    layers = film.exr_pixels({0, 0, film.width(), film.height()}).size();
  }
  std::optional<pelage::PixelBox> region() const override { return {}; }
  uint32_t region_version() const override { return 0; }
  int count = 0;
  size_t layers = 0;
};

}  // namespace

int main() try {
  pelage::ControlMesh mesh;
  mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  mesh.face_sizes = {4};
  mesh.face_vertices = {0, 3, 2, 1};
  const pelage::Value ground = pelage::Value::host({}, pelage::share_mesh(std::move(mesh)));
  const float grass_left_and_right[] = {1, 0.2f};
  const auto bytes = std::as_bytes(std::span(grass_left_and_right));
  const pelage::Value density = pelage::Value::host(
      {}, pelage::share_image({2, 1, 1, pelage::TexelKind::kFloat}, {bytes.begin(), bytes.end()}));
  pelage::SceneSession session(
      pelage::parse_document(kScene, "lawn"),
      {{"skins.ground.mesh", "", ground}, {"grooms.grass.density.map", "", density}});

  pelage::StopSwitch progress;  // progress.stop() on another thread would cancel
  const pelage::Strands grass = session.grow("grass", {}, progress);
  Passes passes;
  pelage::FrameOptions options;
  options.watch = &passes;
  const pelage::RenderedFrame frame = session.render({}, progress, options);
  float brightest = 0;
  for (int x = 0; x < 32; ++x) brightest = std::max(brightest, frame.result.film.radiance(x, 9).y);
  std::printf("%zu strands, %zu points, passes %s, layers %s, light %s\n", grass.strand_count(),
              grass.point_count(), passes.count > 0 ? "seen" : "missed",
              passes.layers > 4 ? "seen" : "missed", brightest > 0 ? "seen" : "missed");
  session.set({{"grooms.grass.operators.lenght.value", "1", {}}});
} catch (const pelage::Error& error) {
  for (const pelage::Problem& problem : error.problems())
    std::printf("%s | %s\n", problem.position.file.c_str(), problem.message.c_str());
  return pelage::library_abi() == pelage::kLibraryAbi ? 0 : 1;
}
