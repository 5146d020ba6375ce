// SPDX-License-Identifier: Apache-2.0
#include "render/accel/kept_fur.h"

namespace pelage {

void KeptFur::replace(std::vector<std::pair<ContentHash, KeptChunk>> chunks) {
  chunks_.clear();
  // Equal coats in equal poses have chunks with equal contents. One of them is kept, preferably a grown one.
  for (auto& [content, chunk] : chunks) {
    KeptChunk& kept = chunks_.try_emplace(key(content)).first->second;
    const bool grown = kept.grown || chunk.grown;
    if (!kept.fur) kept = std::move(chunk);
    kept.grown = grown;
  }
  has_frame_ = true;
}

void KeptFur::free_chunks() {
  for (auto& [content, chunk] : chunks_) {
    chunk.fur = nullptr;
    chunk.charge = {};
  }
}

KeptChunk* KeptFur::find(const ContentHash& content) {
  const auto found = chunks_.find(key(content));
  return found == chunks_.end() ? nullptr : &found->second;
}

}  // namespace pelage
