// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "render/light/skin_shadow.h"

namespace pelage {

/// A shadow ray from a strand, with the fraction of light that it transmits.
struct ShellRay {
  SkinBall ball;  ///< below the strand
  V3f origin{0}, direction{0};
  float far = 0;
  float through = 0;
};

/// Fits a shell of fur to rays: its thickness is the height of the 95th percentile of the origins above their
/// balls; its density minimises the squared error of CoatShell::transmittance(). No shell without rays.
CoatShell fit_shell(std::span<const ShellRay> rays);

}  // namespace pelage
