// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bumpy_ball.h"
#include "render/accel/chunk_grower.h"

namespace pelage {

/// The fur of the bumpy ball in chunks of neighbouring strands, like the leaves of a groom, and the skin of
/// the ball as one more chunk. Each is handed out as a copy.
class BallChunks final : public ChunkGrower {
 public:
  BallChunks(const BumpyBall& ball, size_t chunk_strands);
  ChunkContents grow(uint32_t chunk) const override { return contents_[chunk]; }
  bool is_skin(uint32_t chunk) const override {
    return std::holds_alternative<SkinMesh>(contents_[chunk].geometry);
  }
  uint32_t part(uint32_t chunk) const override { return contents_[chunk].part; }
  ChunkCounts counts(uint32_t chunk) const override;
  StrandScale scale(uint32_t) const override;
  const std::vector<ChunkContents>& contents() const { return contents_; }

 private:
  std::vector<ChunkContents> contents_;
};

/// The strands `strands[begin..end)` of a batch, in that order.
Strands pick(const Strands& batch, const std::vector<uint32_t>& strands, size_t begin, size_t end);
/// Numbers of all strands of a batch, sorted so that ranges of at most `max` are neighbours on the skin;
/// `ends` receives the end of each range.
std::vector<uint32_t> neighbours(const Strands& batch, size_t max, std::vector<size_t>& ends);

}  // namespace pelage
