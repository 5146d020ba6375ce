// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/ledger.h"
#include "bench/bumpy_ball.h"
#include "render/scene/render_scene.h"

namespace pelage {

struct BallPicture {
  int width, height, samples, bounces;
  size_t chunk_strands = 0;  ///< max strands per chunk; 0: one chunk
};

/// The scene for measurements against other renderers: the bumpy ball between two rectangle lights under a
/// constant sky, a box filter of one pixel, no motion.
RenderScene ball_scene(const BumpyBall& ball, const MaterialParams& fibre, const BallPicture& picture,
                       MemoryLedger& ledger);

}  // namespace pelage
