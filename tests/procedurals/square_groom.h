// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "base/hash.h"
#include "base/ledger.h"
#include "base/temporary_folder.h"
#include "geom/io/strand_file.h"
#include "groom/groom.h"
#include "image/texture_library.h"
#include "tests/support/quiet_job.h"

namespace pelage {

/// A groom without operators of the strands of a file. The ledger must outlive the groom.
inline std::shared_ptr<const Groom> groom_of(MemoryLedger& ledger, StrandArrays strands, int leaf_strands) {
  const TemporaryFolder folder;
  GroomParams params;
  params.strands_file = {folder.path() / "square.hair", {}};
  params.leaf_strands = leaf_strands;
  write_strands(params.strands_file.path, Strands(std::move(strands)));
  TextureLibrary textures(ledger);
  return Groom::create("square", params, nullptr, textures, QuietJob(1, ledger));
}

/// Short strands at random places of a square with sides of 2. The ledger must outlive the groom.
inline std::shared_ptr<const Groom> grown_on_a_square(MemoryLedger& ledger, uint32_t count,
                                                      int leaf_strands) {
  StrandArrays a;
  a.first_point = {0};
  for (uint32_t s = 0; s < count; ++s) {
    const V3f root(signed_float(hash64(s, 1)), signed_float(hash64(s, 2)), 0);
    for (uint32_t p = 0; p < 4; ++p) {
      const V3f at = root + V3f(0, 0, 0.01f * static_cast<float>(p));
      a.points.insert(a.points.end(), {at.x, at.y, at.z, 0.001f});
    }
    a.first_point.push_back(4 * (s + 1));
    a.ids.push_back(s);
  }
  return groom_of(ledger, std::move(a), leaf_strands);
}

}  // namespace pelage
