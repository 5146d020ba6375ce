// SPDX-License-Identifier: Apache-2.0
#include "groom/follicle_candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "base/parallel.h"
#include "groom/rotation.h"

namespace pelage {
namespace {

float area_element(const SurfacePoint& point) { return point.du.cross(point.dv).length(); }

/// What candidates of a face need: its area, and bounds for rejection.
struct FaceStatistics {
  double area = 0;
  double mass = 0;
  float largest_element = 0;  // of |du x dv|, by samples
  float largest_density = 0;
};

// Ptex parameters fill a square; those of a triangle (Loop) its lower half.
bool is_triangular(const LimitSurface& rest) { return rest.topology().is_triangular(); }

FaceStatistics measure_face(const LimitSurface& rest, const FollicleDensity& density, uint32_t face,
                            int grid) {
  FaceStatistics result;
  if (rest.topology().is_hole(face)) return result;
  const bool triangle = is_triangular(rest);
  // Gauss-Legendre points and weights of order 4 on [0, 1].
  constexpr float kPlace[] = {0.0694318442f, 0.3300094782f, 0.6699905218f, 0.9305681558f};
  constexpr double kWeight[] = {0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      // A triangle is the square with one side collapsed, (a, b) -> (a, b (1 - a)).
      const float u = kPlace[i], v = triangle ? kPlace[j] * (1 - u) : kPlace[j];
      const float element = area_element(rest.evaluate(face, u, v));
      result.area += kWeight[i] * kWeight[j] * (triangle ? 1 - u : 1) * element;
      result.largest_element = std::max(result.largest_element, element);
    }
  }
  if (!(result.area > 0)) return {};
  double weighted = 0, weights = 0;
  for (int i = 0; i < grid; ++i) {
    for (int j = 0; j < grid; ++j) {
      const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(grid);
      const float v = (static_cast<float>(j) + 0.5f) / static_cast<float>(grid);
      if (triangle && u + v > 1) continue;
      const SurfacePoint point = rest.evaluate(face, u, v);
      const float element = area_element(point);
      const float value = density.at(rest.topology(), {face, u, v}, point);
      result.largest_element = std::max(result.largest_element, element);
      result.largest_density = std::max(result.largest_density, value);
      weighted += static_cast<double>(element) * value;
      weights += element;
    }
  }
  if (weights > 0) result.mass = result.area * weighted / weights;
  return result;
}

std::vector<FaceStatistics> measure_faces(const LimitSurface& rest, const FollicleDensity& density,
                                          const Workers& workers) {
  const size_t faces = rest.topology().face_count();
  const bool uniform = density.is_uniform();
  const int grid =
      uniform ? 4
              : static_cast<int>(std::clamp(
                    std::sqrt(262144.0 / static_cast<double>(std::max<size_t>(faces, 1))), 4.0, 32.0));
  std::vector<FaceStatistics> result(faces);
  workers.for_each(faces, 16, [&](WorkRange range) {
    for (size_t f = range.begin; f < range.end; ++f) {
      result[f] = measure_face(rest, density, static_cast<uint32_t>(f), grid);
    }
  });
  return result;
}

/// A place on a face, uniform by area, that passes the density with probability density / bound.
bool try_candidate(const LimitSurface& rest, const FollicleDensity& density, uint32_t face,
                   const FaceStatistics& statistics, float room, uint64_t stream, FollicleCandidate& out) {
  RootAddress root{face, 0, 0};
  SurfacePoint point;
  V3f normal;
  const float limit = statistics.largest_element * 1.1f;
  // Rejection against |du x dv|; after 64 failures (a face that is nearly a line) any place.
  for (uint64_t attempt = 0; attempt < 64; ++attempt) {
    const uint64_t h = hash64(stream, attempt);
    root.u = unit_float(h);
    root.v = unit_float(mix64(h));
    if (is_triangular(rest) && root.u + root.v > 1) {
      root.u = 1 - root.u;
      root.v = 1 - root.v;
    }
    point = rest.evaluate(face, root.u, root.v);
    normal = point.du.cross(point.dv);
    if (unit_float(mix64(h + 1)) * limit < normal.length()) break;
  }
  const float value = density.at(rest.topology(), root, point);
  const float bound = statistics.largest_density * room;
  if (!(unit_float(hash64(stream, random_use("density"))) * bound < value)) return false;
  out = {point.position.x,        point.position.y,
         point.position.z,        pack_normal(unit_or(normal, V3f(0, 0, 1))),
         1.0f / std::sqrt(value), root};
  return true;
}

}  // namespace

float FollicleDensity::at(const SurfaceTopology& topology, const RootAddress& address,
                          const SurfacePoint& point) const {
  if (is_uniform()) return std::max(field.value({}), 0.0f);
  FieldPoint place;
  place.rest = point.position;
  const V2f uv = topology.texture_coordinates(address.face, address.u, address.v);
  place.u = uv.x;
  place.v = uv.y;
  float value = field.value(place);
  if (coverage && value > 0) value *= coverage(point.position, LimitSurface::frame_of(point).normal);
  return value > 0 && std::isfinite(value) ? value : 0.0f;
}

SurfaceMeasure measure_surface(const LimitSurface& rest, const FollicleDensity& density,
                               const Workers& workers) {
  SurfaceMeasure result;
  for (const FaceStatistics& face : measure_faces(rest, density, workers)) {
    result.area += face.area;
    result.mass += face.mass;
  }
  return result;
}

std::vector<FollicleCandidate> make_candidates(const LimitSurface& rest, const FollicleDensity& density,
                                               uint64_t seed, size_t wanted, const Workers& workers) {
  const std::vector<FaceStatistics> faces = measure_faces(rest, density, workers);
  double mass = 0;
  for (const FaceStatistics& face : faces) mass += face.mass;
  if (!(mass > 0)) return {};

  // Every face tries as many as its area times a bound on its density asks for; the bound leaves room for
  // what lies between the samples.
  const float room = density.is_uniform() ? 1.0f : 1.25f;
  std::vector<uint64_t> first(faces.size() + 1, 0);
  double cumulative = 0;
  for (size_t f = 0; f < faces.size(); ++f) {
    const double limit = faces[f].largest_density * room;
    cumulative += static_cast<double>(wanted) * faces[f].area * limit / mass;
    first[f + 1] = static_cast<uint64_t>(cumulative);
  }

  // Small faces are done together and large ones in parts, whatever the threads.
  const uint64_t tries = first.back();
  constexpr uint64_t kPart = 4096;
  const size_t parts = static_cast<size_t>((tries + kPart - 1) / kPart);
  std::vector<std::vector<FollicleCandidate>> kept(parts);
  std::vector<std::vector<uint64_t>> orders(parts);
  workers.for_each(parts, 1, [&](WorkRange range) {
    for (size_t part = range.begin; part < range.end; ++part) {
      const uint64_t begin = part * kPart, end = std::min(tries, begin + kPart);
      size_t f = static_cast<size_t>(std::upper_bound(first.begin(), first.end(), begin) - first.begin()) - 1;
      for (uint64_t i = begin; i < end; ++i) {
        while (i >= first[f + 1]) ++f;
        const uint64_t stream = hash64(seed, f, i - first[f], random_use("follicle"));
        FollicleCandidate candidate;
        if (!try_candidate(rest, density, static_cast<uint32_t>(f), faces[f], room, stream, candidate))
          continue;
        kept[part].push_back(candidate);
        orders[part].push_back(mix64(stream));
      }
    }
  });

  std::vector<std::pair<uint64_t, std::pair<uint32_t, uint32_t>>> order;
  for (size_t part = 0; part < parts; ++part) {
    for (size_t i = 0; i < kept[part].size(); ++i) {
      order.push_back({orders[part][i], {static_cast<uint32_t>(part), static_cast<uint32_t>(i)}});
    }
    orders[part] = {};
  }
  std::sort(order.begin(), order.end());
  std::vector<FollicleCandidate> result;
  result.reserve(order.size());
  for (const auto& [key, at] : order) result.push_back(kept[at.first][at.second]);
  return result;
}

uint32_t pack_normal(const V3f& normal) {
  const auto bits = [](float c) {
    return static_cast<uint32_t>(std::lround((std::clamp(c, -1.0f, 1.0f) * 0.5f + 0.5f) * 1023.0f));
  };
  return bits(normal.x) | bits(normal.y) << 10 | bits(normal.z) << 20;
}

V3f unpack_normal(uint32_t packed) {
  const auto value = [](uint32_t bits) { return static_cast<float>(bits & 1023) * (2.0f / 1023.0f) - 1.0f; };
  return {value(packed), value(packed >> 10), value(packed >> 20)};
}

}  // namespace pelage
