// SPDX-License-Identifier: Apache-2.0
#include "procedurals/fur.h"

#include "geom/strand_merge.h"

namespace pelage {

FurProcedural::FurProcedural(std::shared_ptr<const Groom> groom,
                             std::shared_ptr<const PosedCharacterSkin> skin)
    : groom_(std::move(groom)), skin_(std::move(skin)) {}

Box3f FurProcedural::bound() const {
  Box3f box;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    box.extendBy(groom_->conservative_bound(leaf, skin_->pose()));
  }
  return box;
}

std::vector<std::unique_ptr<Procedural>> FurProcedural::split() const {
  std::vector<std::unique_ptr<Procedural>> leaves;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf) {
    leaves.push_back(std::make_unique<FurLeafProcedural>(groom_, skin_, leaf));
  }
  return leaves;
}

Strands FurProcedural::generate() const {
  std::vector<Strands> leaves;
  for (size_t leaf = 0; leaf < groom_->follicles().leaves().size(); ++leaf)
    leaves.push_back(groom_->grow(leaf, skin_->pose()));
  return merge(leaves);
}

FurLeafProcedural::FurLeafProcedural(std::shared_ptr<const Groom> groom,
                                     std::shared_ptr<const PosedCharacterSkin> skin, size_t leaf)
    : groom_(std::move(groom)), skin_(std::move(skin)), leaf_(leaf) {}

Box3f FurLeafProcedural::bound() const { return groom_->conservative_bound(leaf_, skin_->pose()); }

Strands FurLeafProcedural::generate() const { return groom_->grow(leaf_, skin_->pose()); }

}  // namespace pelage
