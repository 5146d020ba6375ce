// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "geom/curve_bounds.h"
#include "rib/document/rib_document.h"
#include "rib/scene/rib_reading.h"
#include "tests/fuzz/fuzz_targets.h"
#include "world/scene_schema.h"

namespace pelage {
namespace {

void check_error(const Error& error) {
  PELAGE_CHECK(error.kind() == ErrorKind::kInput);
  for (const Problem& problem : error.problems()) {
    PELAGE_CHECK(!problem.message.empty());
    PELAGE_CHECK(problem.message.find_first_of("\n\r\x1b") == std::string::npos);
  }
}

void check_coat(const RibCoat& coat) {
  if (coat.batches.empty() && coat.deferred.empty()) return;
  for (const auto& leaf : rib_procedural(coat)->split()) {
    const Strands strands = leaf->generate();
    PELAGE_CHECK(strands.strand_count() == leaf->counts().strands);
    PELAGE_CHECK(strands.point_count() == leaf->counts().points);
    const Box3f box = exact_bounds(strands);
    for (int axis = 0; axis < 3; ++axis) {
      PELAGE_CHECK(std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]));
      PELAGE_CHECK(box.min[axis] <= box.max[axis]);
    }
  }
}

}  // namespace

void fuzz_rib(std::span<const uint8_t> bytes) {
  const std::filesystem::path path = fuzz_file(bytes, ".rib");
  RibReadOptions options;
  options.max_points = 100'000;
  options.shutter = V2f(0, 0.5f);
  size_t reserved = 0;
  options.reserve = [&](size_t total) {
    if ((reserved = total) > (4 << 20)) throw Error(ErrorKind::kInput, "the budget of this test is used up");
  };
  try {
    const RibScene rib = read_rib(path, options);
    for (const RibCoat& coat : rib.coats) check_coat(coat);
    for (const RibSkin& skin : rib.skins)
      PELAGE_CHECK(skin.keys.front().size() == skin.cage.positions.size());
  } catch (const Error& error) {
    check_error(error);
  }
  try {
    std::vector<Problem> warnings;
    const Value document = rib_document(path, {}, size_t(1) << 26, warnings);
    SceneDescription scene;
    Problems problems;
    if (SceneDescription::schema().read(document, scene, problems)) check_references(scene, problems);
  } catch (const Error& error) {
    check_error(error);
  }
}

}  // namespace pelage
