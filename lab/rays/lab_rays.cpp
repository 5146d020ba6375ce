// SPDX-License-Identifier: Apache-2.0
#include "lab/rays/lab_rays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/hash.h"
#include "geom/curve.h"
#include "render/accel/flush_denormals.h"

namespace pelage {
namespace {

const std::string kKind = "lab-rays";
constexpr int kTile = 16;  // pixels

float number(uint64_t i, uint64_t use) { return unit_float(hash64(i, use, random_use("lab rays"))); }

V3f direction(uint64_t i, uint64_t use) {
  const float z = 2 * number(i, use) - 1, s = std::sqrt(std::max(0.0f, 1 - z * z));
  const float phi = 2 * std::numbers::pi_v<float> * number(i, use + 1);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// A position on a strand.
struct Place {
  V3f position{0};
  float time = 0, radius = 0;
  FurStart start;
};

Place place_on(const SnappedStrands& snapped, const Strands& strands, uint32_t number_of_segment, float u,
               float time) {
  const SnappedStrands::Place at = snapped.locate(number_of_segment);
  const CubicSegment curve = bezier_segment_at(strands, at.strand, at.segment, time);
  Place place;
  place.position = curve_position(curve, u);
  place.radius = curve_radius(curve, u);
  place.time = time;
  place.start = {snapped.first_segment(at.strand),
                 segment_count(strands.basis(), strands.strand_points(at.strand)),
                 static_cast<float>(at.segment) + u};
  return place;
}

void add(LabRays& set, const Place& from, const V3f& to, float far) {
  Ray ray;
  ray.origin = from.position;
  ray.direction = to;
  ray.far = far;
  ray.time = from.time;
  set.rays.push_back(ray);
  set.starts.push_back(from.start);
  set.clear.push_back(4 * from.radius);
}

LabRays camera_rays(const RenderScene& scene, size_t max) {
  LabRays set{"camera", false, {}, {}, {}};
  const double width = scene.image.width, height = scene.image.height;
  const double scale = std::min(1.0, std::sqrt(static_cast<double>(max) / (width * height)));
  const int columns = std::max(1, static_cast<int>(width * scale)),
            rows = std::max(1, static_cast<int>(height * scale));
  for (int top = 0; top < rows; top += kTile) {
    for (int left = 0; left < columns; left += kTile) {
      for (int y = top; y < std::min(rows, top + kTile); ++y) {
        for (int x = left; x < std::min(columns, left + kTile); ++x) {
          const auto i = static_cast<uint64_t>(y) * static_cast<uint64_t>(columns) + static_cast<uint64_t>(x);
          const CameraRay from = scene.camera.ray(
              (static_cast<float>(x) + number(i, 0)) * static_cast<float>(width) /
                  static_cast<float>(columns),
              (static_cast<float>(y) + number(i, 1)) * static_cast<float>(height) / static_cast<float>(rows),
              {number(i, 2), number(i, 3)}, number(i, 4));
          Ray ray;
          ray.origin = from.origin;
          ray.direction = from.direction;
          ray.time = from.time;
          set.rays.push_back(ray);
        }
      }
    }
  }
  set.starts.resize(set.size());
  set.clear.resize(set.size(), 0.0f);
  return set;
}

/// Interleaves the bits of x, y and z.
uint64_t morton(const V3f& p) {
  uint64_t code = 0;
  for (int bit = 9; bit >= 0; --bit) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<uint32_t>(std::clamp(p[axis], 0.0f, 1.0f) * 1023);
      code = code << 1 | (cell >> bit & 1);
    }
  }
  return code;
}

LabRays sorted(const LabRays& set, const Box3f& box) {
  const V3f size = box.size();
  std::vector<uint64_t> keys(set.size());
  for (size_t i = 0; i < set.size(); ++i) {
    const Ray& ray = set.rays[i];
    V3f place;
    for (int a = 0; a < 3; ++a) place[a] = size[a] > 0 ? (ray.origin[a] - box.min[a]) / size[a] : 0;
    uint64_t octant = 0;
    for (int a = 0; a < 3; ++a) octant = octant << 1 | (ray.direction[a] < 0 ? 1 : 0);
    keys[i] = octant << 30 | morton(place);
  }
  std::vector<uint32_t> order(set.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  LabRays result{"sorted", set.shadow, {}, {}, {}};
  for (const uint32_t i : order) {
    result.rays.push_back(set.rays[i]);
    result.starts.push_back(set.starts[i]);
    result.clear.push_back(set.clear[i]);
  }
  return result;
}

/// A ray in a file.
struct StoredRay {
  float origin[3], direction[3];
  float far, time, clear, place;
  uint32_t first_segment, segment_count;
};

}  // namespace

std::vector<LabRays> make_lab_rays(const RenderScene& scene, const Strands& strands,
                                   const SnappedStrands& snapped, const FurTree& tree, size_t max) {
  const FlushDenormals flush;
  std::vector<LabRays> sets{camera_rays(scene, max)};
  std::vector<Place> hits;
  for (const Ray& ray : sets[0].rays) {
    const FurHit hit = tree.closest(ray, {});
    if (!hit) continue;
    hits.push_back(place_on(snapped, strands, hit.number, hit.u, ray.time));
    // The hit on the ribbon, not on its axis.
    hits.back().position = ray.origin + hit.distance * ray.direction;
  }
  if (hits.empty()) throw Error(ErrorKind::kArguments, "the camera sees no fur, so no rays can start there");

  LabRays gather{"gather", false, {}, {}, {}}, shadow{"shadow", true, {}, {}, {}},
      deep{"deep", true, {}, {}, {}};
  Box3f box;
  std::vector<float> lights(scene.lights.size());
  for (size_t i = 0; i < max; ++i) {
    // In the order of the hits, several from each if there are few.
    const Place& from = hits[i * hits.size() / max];
    box.extendBy(from.position);
    add(gather, from, direction(i, 10), std::numeric_limits<float>::infinity());
    const auto segment =
        static_cast<uint32_t>(hash64(i, random_use("lab segment")) % snapped.segment_count());
    add(deep, place_on(snapped, strands, segment, number(i, 20), number(i, 21)), direction(i, 22),
        std::numeric_limits<float>::infinity());
    if (scene.lights.size() == 0) continue;
    scene.lights.probabilities(from.position, lights);
    const LightSet::Choice choice = LightSet::choose(lights, number(i, 30));
    if (choice.probability <= 0) continue;
    const auto light = scene.lights.light(choice.light).sample(from.position, {number(i, 31), number(i, 32)});
    if (light) add(shadow, from, light->direction, light->distance * (1 - 1e-4f));
  }
  sets.push_back(gather);
  sets.push_back(sorted(gather, box));
  if (shadow.size() > 0) sets.push_back(std::move(shadow));
  sets.push_back(std::move(deep));
  return sets;
}

void store_lab_rays(const ContentStore& store, const std::vector<LabRays>& sets) {
  ContentStore::Writer writer = store.writer(kKind, kLabKey);
  for (const LabRays& set : sets) {
    const std::string name = set.name + (set.shadow ? "!" : "");
    writer.add(std::span<const char>(name));
    std::vector<StoredRay> stored;
    stored.reserve(set.size());
    for (size_t i = 0; i < set.size(); ++i) {
      const Ray& r = set.rays[i];
      const FurStart& s = set.starts[i];
      stored.push_back({{r.origin.x, r.origin.y, r.origin.z},
                        {r.direction.x, r.direction.y, r.direction.z},
                        r.far,
                        r.time,
                        set.clear[i],
                        s.place,
                        s.first_segment,
                        s.segment_count});
    }
    writer.add(std::span<const StoredRay>(stored));
  }
  writer.commit([](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
}

std::vector<LabRays> load_lab_rays(const ContentStore& store) {
  const auto file =
      store.open(kKind, kLabKey, [](const std::string& line) { throw Error(ErrorKind::kFailed, line); });
  if (!file) throw Error(ErrorKind::kFailed, store.folder().string() + ": no prepared rays found here");
  std::vector<LabRays> sets;
  for (size_t section = 0; section + 1 < file->section_count(); section += 2) {
    const auto name = file->section(section), rays = file->section(section + 1);
    LabRays set;
    set.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
    if (set.name.ends_with('!')) {
      set.shadow = true;
      set.name.pop_back();
    }
    std::vector<StoredRay> stored(rays.size() / sizeof(StoredRay));
    if (!stored.empty()) std::memcpy(stored.data(), rays.data(), stored.size() * sizeof(StoredRay));
    for (const StoredRay& s : stored) {
      Ray ray;
      ray.origin = V3f(s.origin[0], s.origin[1], s.origin[2]);
      ray.direction = V3f(s.direction[0], s.direction[1], s.direction[2]);
      ray.far = s.far;
      ray.time = s.time;
      set.rays.push_back(ray);
      set.starts.push_back({s.first_segment, s.segment_count, s.place});
      set.clear.push_back(s.clear);
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace pelage
