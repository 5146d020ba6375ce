// SPDX-License-Identifier: Apache-2.0
#include "geom/mesh.h"

#include <algorithm>
#include <numeric>

namespace pelage {

namespace {

template <class T>
size_t vector_bytes(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

/// Marks the faces to remove, and clears `hole` where a face is one of several of which one is no hole.
std::vector<bool> repeated_faces(const ControlMesh& mesh, std::vector<bool>& hole) {
  struct Key {
    uint64_t hash;  // of the vertices, in any order
    uint32_t face, first_corner;
  };
  std::vector<Key> keys;
  keys.reserve(mesh.face_count());
  uint32_t first = 0;
  for (uint32_t face = 0; face < mesh.face_count(); first += mesh.face_sizes[face], ++face) {
    uint64_t sum = mesh.face_sizes[face];
    for (uint32_t i = 0; i < mesh.face_sizes[face]; ++i) sum += mix64(mesh.face_vertices[first + i] + 1);
    keys.push_back({sum, face, first});
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& a, const Key& b) { return a.hash != b.hash ? a.hash < b.hash : a.face < b.face; });
  const auto vertices = [&](const Key& key) {
    const auto begin = mesh.face_vertices.begin() + key.first_corner;
    std::vector<uint32_t> sorted(begin, begin + mesh.face_sizes[key.face]);
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  std::vector<bool> repeated(mesh.face_count());
  for (size_t i = 0, original = 0; i < keys.size(); ++i) {
    // Different faces with equal hashes would only be kept.
    if (keys[i].hash != keys[original].hash || vertices(keys[i]) != vertices(keys[original])) original = i;
    if (original == i) continue;
    repeated[keys[i].face] = true;
    if (!hole[keys[i].face]) hole[keys[original].face] = false;
  }
  return repeated;
}

}  // namespace

size_t merge_equal_faces(ControlMesh& mesh) {
  const size_t corners = std::accumulate(mesh.face_sizes.begin(), mesh.face_sizes.end(), size_t(0));
  const bool has_uv = !mesh.face_uv.empty();
  std::vector<uint16_t>* const per_face[] = {&mesh.face_groups, &mesh.objects.faces, &mesh.materials.faces};
  const bool names_fit = std::all_of(std::begin(per_face), std::end(per_face), [&](const auto* names) {
    return names->empty() || names->size() == mesh.face_count();
  });
  if (corners != mesh.face_vertices.size() || (has_uv && mesh.face_uv.size() != corners) || !names_fit)
    return 0;
  std::vector<bool> hole(mesh.face_count());
  for (const uint32_t face : mesh.holes) {
    if (face < hole.size()) hole[face] = true;
  }
  const std::vector<bool> repeated = repeated_faces(mesh, hole);
  size_t kept = 0, kept_corners = 0, corner = 0;
  mesh.holes.clear();
  for (size_t face = 0; face < repeated.size(); ++face) {
    const uint32_t size = mesh.face_sizes[face];
    if (!repeated[face]) {
      const auto move = [&](std::vector<uint32_t>& values) {
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(corner), size,
                    values.begin() + static_cast<std::ptrdiff_t>(kept_corners));
      };
      move(mesh.face_vertices);
      if (has_uv) move(mesh.face_uv);
      for (auto* names : per_face) {
        if (!names->empty()) (*names)[kept] = (*names)[face];
      }
      if (hole[face]) mesh.holes.push_back(static_cast<uint32_t>(kept));
      mesh.face_sizes[kept++] = size;
      kept_corners += size;
    }
    corner += size;
  }
  mesh.face_sizes.resize(kept);
  mesh.face_vertices.resize(kept_corners);
  if (has_uv) mesh.face_uv.resize(kept_corners);
  for (auto* names : per_face) {
    if (!names->empty()) names->resize(kept);
  }
  return repeated.size() - kept;
}

MeshOrder mesh_order(const ControlMesh& mesh) {
  ContentHasher hasher;
  size_t first = 0;
  for (const uint32_t size : mesh.face_sizes) {
    hasher.add(std::span(mesh.face_vertices).subspan(first, size));
    first += size;
  }
  return {mesh.positions.size(), hasher.digest()};
}

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
         vector_bytes(face_groups) + vector_bytes(groups) + vector_bytes(objects.faces) +
         vector_bytes(objects.names) + vector_bytes(materials.faces) + vector_bytes(materials.names) +
         vector_bytes(colors);
}

}  // namespace pelage
