// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "geom/curve_bounds.h"
#include "geom/io/strand_file.h"
#include "tests/fuzz/fuzz_targets.h"

namespace pelage {
namespace {

void feed(std::span<const uint8_t> bytes, const std::string& ending) {
  const std::filesystem::path path = fuzz_file(bytes, ending);
  for (CurveBasis basis : {CurveBasis::kPinnedBSpline, CurveBasis::kBSpline}) {
    StrandReadOptions options;
    options.basis = basis;
    try {
      const Strands strands = read_strands(path, options).strands;
      if (strands.strand_count() == 0) continue;
      const Box3f box = exact_bounds(strands);
      for (int axis = 0; axis < 3; ++axis) {
        PELAGE_CHECK(std::isfinite(box.min[axis]) && std::isfinite(box.max[axis]));
        PELAGE_CHECK(box.min[axis] <= box.max[axis]);
      }
    } catch (const Error& error) {
      PELAGE_CHECK(error.kind() == ErrorKind::kInput);
    }
  }
}

}  // namespace

void fuzz_hair(std::span<const uint8_t> bytes) { feed(bytes, ".hair"); }
void fuzz_tfx(std::span<const uint8_t> bytes) { feed(bytes, ".tfx"); }

}  // namespace pelage
