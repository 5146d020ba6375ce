// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/accel/kept_fur.h"
#include "render/frame/frame_geometry.h"
#include "world/world.h"

namespace pelage {

/// Renders like render(world, job, options), with geometry that is kept between calls. See render_frame() and
/// recompose_sampling().
FrameResult render(const World& world, const Job& job, const FrameOptions& options,
                   std::unique_ptr<FrameGeometry>& geometry, KeptFur* kept = nullptr);

}  // namespace pelage
