// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/error.h"
#include "base/page_block.h"
#include "base/parallel.h"
#include "render/accel/flush_denormals.h"
#include "render/accel/fur/paged_fur.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/fuzz/right_checksums.h"

namespace pelage {
namespace {

Ray ray_of(int i) {
  Ray ray;
  ray.origin = V3f(0.1f * static_cast<float>(i) - 0.4f, 0.2f, 3);
  ray.direction = V3f(0.03f * static_cast<float>(i % 3), -0.02f, -1).normalized();
  ray.time = 0.1f * static_cast<float>(i);
  return ray;
}

void feed(std::span<const uint8_t> bytes) {
  try {
    FurPageFile file{StoredSections(fuzz_file(bytes, ".cache"))};
    MemoryLedger ledger;
    const PagedFur fur(std::move(file), {}, ledger, Workers::alone());
    PagedFurCounts counts;
    for (int i = 0; i < 8; ++i) {
      const PagedFurHit hit = fur.closest(ray_of(i), {}, 0, counts);
      PELAGE_CHECK(!hit || hit.tree < fur.table().trees.size());
      fur.occluded(ray_of(i), {}, 0, counts);
    }
    std::vector<Ray> rays;
    for (int i = 0; i < 8; ++i) rays.push_back(ray_of(i));
    std::vector<PagedFurHit> hits(rays.size());
    std::vector<uint8_t> answers(rays.size());
    fur.closest(rays, {}, 0, hits, counts);
    fur.occluded(rays, {}, 0, answers, counts);
  } catch (const Error& error) {
    PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  }
}

}  // namespace

void fuzz_fur(std::span<const uint8_t> bytes) {
  const FlushDenormals flush;
  feed(bytes);
  feed(with_right_checksums(bytes));
}

void fuzz_treelet(std::span<const uint8_t> bytes) {
  if (bytes.size() < 64) return;
  // What a table would say of the page that follows.
  FurPagedTree tree;
  tree.layout = bytes[0] % 2 == 0 ? FurNodeLayout::kQuantised : FurNodeLayout::kFloat;
  tree.motion_keys = 1 + bytes[1] % 3;
  tree.step = std::ldexp(1.0f, -8 + bytes[2] % 16);
  tree.reach = 1e4f;
  if (bytes[4] % 2 == 1) tree.frame = {{V3f(0.6f, 0.8f, 0), V3f(0, 0, 1), V3f(0.8f, -0.6f, 0)}, true};
  const std::span<const uint8_t> content = bytes.subspan(16);
  FurTreelet treelet;
  treelet.end = static_cast<uint32_t>(content.size());
  const uint32_t nodes = 1 + bytes[3];
  treelet.leaves = nodes * static_cast<uint32_t>(node_size(tree.layout, tree.motion_keys));
  if (treelet.leaves > treelet.end) return;
  PageBlock page(content.size());
  std::memcpy(page.data(), content.data(), content.size());
  const FurTreeView view = treelet_view(tree, treelet, page.data());
  if (!is_possible_treelet(view, treelet)) return;
  const FlushDenormals flush;
  for (int i = 0; i < 8; ++i) {
    closest_fur(view, ray_of(i), {}, nullptr);
    fur_occludes(view, ray_of(i), {}, nullptr);
  }
}

}  // namespace pelage
