// SPDX-License-Identifier: Apache-2.0
#include "procedurals/skin/skin_pose.h"

#include <algorithm>

namespace pelage {

size_t SkinPose::bytes() const {
  size_t sum = sizeof(*this) + transforms.capacity() * sizeof(M44f) + (mesh ? mesh->bytes() : 0);
  for (const LimitSurface& key : keys) sum += key.bytes();
  for (const ClosestPointTree& tree : trees) sum += tree.bytes();
  return sum;
}

void add_faces(const Groom& groom, size_t leaf, size_t count, std::vector<uint32_t>& faces) {
  if (!groom.grows_on_skin()) return;
  const FollicleTree& follicles = groom.follicles();
  const uint32_t begin = follicles.leaves()[leaf].begin;
  for (size_t f = begin; f < begin + count; ++f) {
    const uint32_t face = follicles.root(f).face;
    if (faces.empty() || faces.back() != face) faces.push_back(face);
  }
}

std::vector<uint32_t> leaf_faces(const Groom& groom, size_t leaf) {
  std::vector<uint32_t> faces;
  const FollicleTree::Leaf& range = groom.follicles().leaves()[leaf];
  add_faces(groom, leaf, range.end - range.begin, faces);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

}  // namespace pelage
