// SPDX-License-Identifier: Apache-2.0
#include "geom/mesh.h"

namespace pelage {

namespace {

template <class T>
size_t vector_bytes(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

int distinct_corners(std::span<const uint32_t> face) {
  if (face.empty()) return 0;
  size_t second = 0;
  for (size_t i = 1; i < face.size(); ++i) {
    if (face[i] == face[0]) continue;
    if (second == 0) {
      second = i;
    } else if (face[i] != face[second]) {
      return 3;
    }
  }
  return second == 0 ? 1 : 2;
}

size_t ControlMesh::bytes() const {
  return vector_bytes(positions) + vector_bytes(face_sizes) + vector_bytes(face_vertices) + vector_bytes(uv) +
         vector_bytes(face_uv) + vector_bytes(creases) + vector_bytes(corners) + vector_bytes(holes) +
         vector_bytes(face_groups) + vector_bytes(groups);
}

}  // namespace pelage
