// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/accel/fur/fur_ray.h"
#include "render/accel/fur/paged_fur.h"

namespace pelage {

/// Query for the nearest hit: the state of one ray that visits treelets one after the other.
struct PagedFur::Nearest {
  using Answer = PagedFurHit;
  static constexpr ChunkWalk::Order kOrder = ChunkWalk::Order::kFrontToBack;
  static constexpr bool kNearestFirst = true;

  /// `so_far` is the nearest hit so far. test() replaces it when it finds a hit that precedes it.
  Nearest(const Ray& of, const PagedFurStart& from, PagedFurHit& so_far)
      : ray(of), start(from), best(so_far) {}

  /// Returns the far end (exclusive) for further tests. It is just behind the current hit, because a hit at
  /// the same distance may precede the current one.
  float far() const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return best ? std::min(ray.far, std::nextafter(best.hit.distance, kInfinity)) : ray.far;
  }
  /// Tests one treelet. Returns false when the ray is finished, which this query never is.
  bool test(const FurTreeView& view, uint32_t tree, FurTests* tests) {
    Ray shorter = ray;
    shorter.far = far();
    const FurRay* prepared = rays.prepare(view, shorter, tree == start.tree ? start.start : FurStart());
    if (!prepared) return true;
    const PagedFurHit found{closest_fur(view, *prepared, nullptr, tests), tree};
    if (found && (!best || found.precedes(best))) best = found;
    return true;
  }

  const Ray& ray;
  const PagedFurStart start;
  PagedFurHit& best;
  FurRays rays;
};

/// Query for any hit: the state of one ray that visits treelets one after the other.
struct PagedFur::Any {
  using Answer = uint8_t;
  static constexpr ChunkWalk::Order kOrder = ChunkWalk::Order::kLongestFirst;
  static constexpr bool kNearestFirst = false;

  Any(const Ray& of, const PagedFurStart& from, uint8_t& answer) : ray(of), start(from), hit(answer) {}

  float far() const { return ray.far; }
  bool test(const FurTreeView& view, uint32_t tree, FurTests* tests) {
    const FurRay* prepared = rays.prepare(view, ray, tree == start.tree ? start.start : FurStart());
    if (prepared && fur_occludes(view, *prepared, nullptr, tests)) hit = 1;
    return hit == 0;
  }

  const Ray& ray;
  const PagedFurStart start;
  uint8_t& hit;
  FurRays rays;
};

}  // namespace pelage
