// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/accel/fur/paged_fur.h"

// What a ray asks of one treelet after the other.
namespace pelage {

struct PagedFur::Nearest {
  Nearest(const Ray& of, const PagedFurStart& from) : ray(of), start(from) {}

  static constexpr ChunkWalk::Order kOrder = ChunkWalk::Order::kFrontToBack;
  static constexpr bool kNearestFirst = true;
  /// As far as something can still stand before what there is: as near, too.
  float far() const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return best ? std::min(ray.far, std::nextafter(best.hit.distance, kInfinity)) : ray.far;
  }
  bool test(const FurTreeView& view, uint32_t tree, FurTests* tests) {
    Ray shorter = ray;
    shorter.far = far();
    const PagedFurHit found{
        closest_fur(view, shorter, tree == start.tree ? start.start : FurStart(), nullptr, tests), tree};
    if (found && (!best || found.stands_before(best))) best = found;
    return true;
  }

  Ray ray;
  PagedFurStart start;
  PagedFurHit best;
};

struct PagedFur::Any {
  Any(const Ray& of, const PagedFurStart& from) : ray(of), start(from) {}

  static constexpr ChunkWalk::Order kOrder = ChunkWalk::Order::kLongestFirst;
  static constexpr bool kNearestFirst = false;
  float far() const { return ray.far; }
  bool test(const FurTreeView& view, uint32_t tree, FurTests* tests) {
    hit = fur_occludes(view, ray, tree == start.tree ? start.start : FurStart(), nullptr, tests);
    return !hit;
  }

  Ray ray;
  PagedFurStart start;
  bool hit = false;
};

}  // namespace pelage
