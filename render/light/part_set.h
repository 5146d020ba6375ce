// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace pelage {

/// A coat or a skin of a frame.
struct FramePart {
  bool is_skin = false;
  uint32_t index = 0;  ///< in RenderScene::fur or RenderScene::skins
};

/// A set of coats and skins of a frame. Immutable once a ray or a light refers to it.
class PartSet {
 public:
  void add(const FramePart& part) {
    std::vector<bool>& set = part.is_skin ? skins_ : fur_;
    if (part.index >= set.size()) set.resize(part.index + 1, false);
    set[part.index] = true;
    empty_ = false;
  }
  bool contains(const FramePart& part) const {
    const std::vector<bool>& set = part.is_skin ? skins_ : fur_;
    return part.index < set.size() && set[part.index];
  }
  bool empty() const { return empty_; }

 private:
  std::vector<bool> fur_, skins_;
  bool empty_ = true;
};

}  // namespace pelage
