// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace pelage {

class SkinShadows;
class VisibilityTable;

/// What is known about occlusion before shadow rays are traced. Null: not used.
struct KnownOcclusion {
  const SkinShadows* balls = nullptr;
  const VisibilityTable* visibility = nullptr;
};

}  // namespace pelage
