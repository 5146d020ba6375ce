// SPDX-License-Identifier: Apache-2.0
#include "geom/manifold.h"

#include <algorithm>
#include <span>

namespace pelage {
namespace {

/// Neighbours of a vertex in one of its faces.
struct Wedge {
  uint32_t before, after;
};

/// Joins each wedge of a vertex to the one that begins where it ends. A manifold vertex has one chain or one
/// cycle. Sorts the wedges. `next` and `has_previous` are reused.
VertexFan fan_of(uint32_t vertex, std::span<Wedge> wedges, std::vector<size_t>& next,
                 std::vector<bool>& has_previous) {
  const size_t count = wedges.size();
  if (count == 0) return VertexFan::kOpen;
  std::sort(wedges.begin(), wedges.end(), [](Wedge a, Wedge b) { return a.before < b.before; });
  next.assign(count, count);
  has_previous.assign(count, false);
  for (size_t i = 0; i < count; ++i) {
    const auto [before, after] = wedges[i];
    if (before == vertex || after == vertex || (i > 0 && wedges[i - 1].before == before))
      return VertexFan::kTangled;
    const auto found = std::lower_bound(wedges.begin(), wedges.end(), after,
                                        [](Wedge wedge, uint32_t v) { return wedge.before < v; });
    if (found == wedges.end() || found->before != after) continue;
    next[i] = static_cast<size_t>(found - wedges.begin());
    if (has_previous[next[i]]) return VertexFan::kTangled;
    has_previous[next[i]] = true;
  }
  const auto first = std::find(has_previous.begin(), has_previous.end(), false);
  const bool is_open = first != has_previous.end();
  const size_t head = is_open ? static_cast<size_t>(first - has_previous.begin()) : 0;
  size_t walked = 0, at = head;
  do {
    ++walked;
    at = next[at];
  } while (at != count && at != head);
  return walked < count ? VertexFan::kTangled : is_open ? VertexFan::kOpen : VertexFan::kClosed;
}

/// Calls `use(vertex, before, after)` for each corner.
template <class Use>
void for_each_corner(const ControlMesh& mesh, const Use& use) {
  size_t first = 0;
  for (const size_t size : mesh.face_sizes) {
    if (first + size > mesh.face_vertices.size()) return;
    const auto face = std::span(mesh.face_vertices).subspan(first, size);
    for (size_t i = 0; i < size; ++i) {
      if (face[i] < mesh.positions.size()) use(face[i], face[(i + size - 1) % size], face[(i + 1) % size]);
    }
    first += size;
  }
}

}  // namespace

std::vector<VertexFan> vertex_fans(const ControlMesh& mesh) {
  const size_t vertices = mesh.positions.size();
  std::vector<size_t> end(vertices + 1);
  for_each_corner(mesh, [&](uint32_t v, uint32_t, uint32_t) { ++end[v + 1]; });
  for (size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<Wedge> wedges(end[vertices]);
  // end[v] moves from the first wedge of v to the end of its wedges.
  for_each_corner(mesh, [&](uint32_t v, uint32_t before, uint32_t after) {
    wedges[end[v]++] = {before, after};
  });
  std::vector<VertexFan> result(vertices);
  std::vector<bool> has_previous;
  std::vector<size_t> next;
  for (uint32_t v = 0; v < vertices; ++v) {
    const size_t begin = v == 0 ? 0 : end[v - 1];
    result[v] = fan_of(v, std::span(wedges).subspan(begin, end[v] - begin), next, has_previous);
  }
  return result;
}

size_t tangled_face_count(const ControlMesh& mesh, const std::vector<VertexFan>& fans) {
  size_t count = 0, first = 0;
  for (const size_t size : mesh.face_sizes) {
    if (first + size > mesh.face_vertices.size()) break;
    const auto face = std::span(mesh.face_vertices).subspan(first, size);
    first += size;
    count += std::any_of(face.begin(), face.end(),
                         [&](uint32_t v) { return v < fans.size() && fans[v] == VertexFan::kTangled; });
  }
  return count;
}

}  // namespace pelage
