// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_lattice.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace pelage {

namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr uint64_t kMostElements = std::numeric_limits<int32_t>::max();

}  // namespace

uint32_t SkinLattice::Rail::vertex(uint32_t k) const {
  const uint32_t position = step > 0 ? base + k : base - k;
  if (position == 0) return line->start;
  return position == line->rate ? line->end : line->inner + position - 1;
}

SkinLattice::SkinLattice(const SurfaceTopology::Impl& topology) : topology_(topology) {
  const CageConnectivity& cage = topology_.cage;
  const auto face_count = static_cast<uint32_t>(topology_.cage_face.size());
  lines_.resize(cage.edge_count());
  spoke_.assign(face_count, kNone);
  for (uint32_t face = 0; face < face_count; ++face) {
    const uint32_t whole = topology_.cage_face[face];
    if (cage.first_ptex[whole + 1] - cage.first_ptex[whole] == 1) continue;
    spoke_[face] = static_cast<uint32_t>(lines_.size());
    lines_.emplace_back();
  }
  for (uint32_t face = 0; face < face_count; ++face) {
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
      const uint32_t index = line_of(face, side);
      Line& line = lines_[index];
      const bool is_half = is_edge(index) && spoke_[face] != kNone;
      line.halved = line.halved || is_half;
      if (line.used || topology_.hole[face]) continue;
      line.used = true;
      line.face = face;
      line.side = side;
      line.is_half = is_half;
    }
  }
}

uint32_t SkinLattice::line_of(uint32_t face, uint32_t side) const {
  const CageConnectivity& cage = topology_.cage;
  const uint32_t whole = topology_.cage_face[face];
  const uint32_t* edges = &cage.corner_edge[cage.first_corner[whole]];
  if (spoke_[face] == kNone) return edges[side];
  const uint32_t first = cage.first_ptex[whole], n = cage.face_size(whole);
  const uint32_t corner = face - first, before = (corner + n - 1) % n;
  switch (side) {
    case 0:
      return edges[corner];
    case 1:
      return spoke_[face];
    case 2:
      return spoke_[first + before];
    default:
      return edges[before];
  }
}

SkinLattice::Rail SkinLattice::rail(uint32_t face, uint32_t side) const {
  const CageConnectivity& cage = topology_.cage;
  const uint32_t index = line_of(face, side);
  const Line& line = lines_[index];
  if (!is_edge(index)) {
    return side == 1 ? Rail{&line, 0, 1, line.rate} : Rail{&line, line.rate, -1, line.rate};
  }
  // Edges run one way, the faces around them both ways.
  const uint32_t whole = topology_.cage_face[face], n = cage.face_size(whole);
  const bool split = spoke_[face] != kNone;
  const uint32_t corner = split ? face - cage.first_ptex[whole] : side;
  const uint32_t from = split && side == 3 ? (corner + n - 1) % n : corner;
  const bool forward =
      cage.corner_vertex[cage.first_corner[whole] + from] == cage.edge_vertices[size_t(index) * 2];
  const int step = forward ? 1 : -1;
  if (!split) return {&line, forward ? 0 : line.rate, step, line.rate};
  const uint32_t half = line.rate / 2;
  if (side == 3) return {&line, half, step, half};
  return {&line, forward ? 0 : line.rate, step, half};
}

V2f SkinLattice::side_uv(uint32_t side, float t) const {
  if (topology_.triangular) return side == 0 ? V2f(t, 0) : side == 1 ? V2f(1 - t, t) : V2f(0, 1 - t);
  switch (side) {
    case 0:
      return {t, 0};
    case 1:
      return {1, t};
    case 2:
      return {1 - t, 1};
    default:
      return {0, 1 - t};
  }
}

uint32_t SkinLattice::new_points(uint64_t count) {
  const size_t first = points_.size();
  if (first + count > kMostElements) {
    throw Error(ErrorKind::kMemory, "a tessellated skin would have more than 2147483647 vertices");
  }
  points_.resize(first + count);
  return static_cast<uint32_t>(first);
}

void SkinLattice::number_line(uint32_t index) {
  Line& line = lines_[index];
  if (line.inner != kNone) return;
  line.inner = new_points(line.rate - 1);
  if (is_edge(index)) {
    for (int end = 0; end < 2; ++end) {
      uint32_t& vertex =
          cage_vertices_[topology_.cage.edge_vertices[size_t(index) * 2 + static_cast<size_t>(end)]];
      if (vertex == kNone) vertex = new_points(1);
      (end == 0 ? line.start : line.end) = vertex;
    }
    return;
  }
  // The centre belongs to the n-gon's first spoke, which is numbered before the others.
  const uint32_t first = spoke_[topology_.cage.first_ptex[topology_.cage_face[line.face]]];
  if (lines_[first].end == kNone) lines_[first].end = new_points(1);
  line.end = lines_[first].end;
}

void SkinLattice::divide(uint32_t face) {
  Face& f = faces_[face];
  uint64_t rates[4] = {0, 0, 0, 0}, sum = 0;
  for (uint32_t side = 0; side < topology_.corners_per_face(); ++side)
    sum += rates[side] = rail(face, side).rate;
  uint64_t inner = 0, triangles = 0;
  if (topology_.triangular) {
    uint64_t n = std::max({rates[0], rates[1], rates[2]});
    if (n > 1) n = std::max<uint64_t>(n, 3);
    inner = n > 1 ? (n - 1) * (n - 2) / 2 : 0;
    triangles = n > 1 ? sum + 3 * (n - 3) + (n - 3) * (n - 3) : 1;
    f.nu = f.nv = static_cast<uint32_t>(n);
  } else {
    const uint64_t nu = std::max(rates[0], rates[2]), nv = std::max(rates[1], rates[3]);
    inner = (nu - 1) * (nv - 1);
    triangles = nu == 1   ? rates[1] + rates[3]
                : nv == 1 ? rates[0] + rates[2]
                          : sum + 2 * (nu - 2 + nv - 2) + 2 * (nu - 2) * (nv - 2);
    f.nu = static_cast<uint32_t>(nu);
    f.nv = static_cast<uint32_t>(nv);
  }
  f.inner = new_points(inner);
  f.triangle = static_cast<uint32_t>(triangle_count_);
  triangle_count_ += triangles;
  if (triangle_count_ > kMostElements) {
    throw Error(ErrorKind::kMemory, "a tessellated skin would have more than 2147483647 triangles");
  }
}

void SkinLattice::place_rails(uint32_t face) {
  for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
    const Rail r = rail(face, side);
    for (uint32_t k = 0; k <= r.rate; ++k) {
      LatticePoint& point = points_[r.vertex(k)];
      if (point.face == kNone)
        point = {face, side_uv(side, static_cast<float>(k) / static_cast<float>(r.rate))};
    }
  }
}

void SkinLattice::place_inner(uint32_t face) {
  const Face& f = faces_[face];
  const float du = 1.0f / static_cast<float>(f.nu), dv = 1.0f / static_cast<float>(f.nv);
  uint32_t vertex = f.inner;
  for (uint32_t j = 1; j < f.nv; ++j) {
    const uint32_t end = topology_.triangular ? f.nu - j : f.nu;
    for (uint32_t i = 1; i < end; ++i) {
      points_[vertex++] = {face, V2f(static_cast<float>(i) * du, static_cast<float>(j) * dv)};
    }
  }
}

void SkinLattice::number() {
  cage_vertices_.assign(topology_.control_count, kNone);
  faces_.assign(topology_.cage_face.size(), {});
  points_.clear();
  triangle_count_ = 0;
  for (Line& line : lines_) line.start = line.end = line.inner = kNone;
  for (uint32_t face = 0; face < faces_.size(); ++face) {
    faces_[face].triangle = static_cast<uint32_t>(triangle_count_);
    if (topology_.hole[face]) continue;
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) number_line(line_of(face, side));
    divide(face);
  }
  for (LatticePoint& point : points_) point.face = kNone;
  // Spokes start in the middle of an edge, which has its vertices by now.
  for (uint32_t face = 0; face < faces_.size(); ++face) {
    if (topology_.hole[face] || spoke_[face] == kNone) continue;
    const Rail half = rail(face, 0);
    lines_[spoke_[face]].start = half.vertex(half.rate);
  }
  for (uint32_t face = 0; face < faces_.size(); ++face) {
    if (topology_.hole[face]) continue;
    place_rails(face);
    place_inner(face);
  }
}

void SkinLattice::visit_split(const std::function<void(uint32_t, const LatticePoint&)>& visit) const {
  const CageConnectivity& cage = topology_.cage;
  const auto end_is_split = [&](uint32_t edge, bool start) {
    return cage.vertex_split[cage.edge_vertices[size_t(edge) * 2 + (start ? 0 : 1)]] != 0;
  };
  for (uint32_t face = 0; face < faces_.size(); ++face) {
    if (topology_.hole[face]) continue;
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
      const uint32_t index = line_of(face, side);
      if (!is_edge(index)) continue;
      const Line& line = lines_[index];
      if (!cage.edge_split[index] && !end_is_split(index, true) && !end_is_split(index, false)) continue;
      const Rail r = rail(face, side);
      // The last node is the first of another side: each face counts once at each vertex.
      for (uint32_t k = 0; k < r.rate; ++k) {
        const uint32_t vertex = r.vertex(k);
        const bool at_start = vertex == line.start, at_end = vertex == line.end;
        const bool split = at_start || at_end ? end_is_split(index, at_start) : cage.edge_split[index] != 0;
        if (split) visit(vertex, {face, side_uv(side, static_cast<float>(k) / static_cast<float>(r.rate))});
      }
    }
  }
}

/// Writes triangles one after the other.
class SkinLattice::Writer {
 public:
  struct Node {
    uint32_t vertex;
    V2f uv;
  };

  Writer(const SkinLattice& lattice, uint32_t face, uint32_t* triangles, uint32_t* faces, V2f* uv)
      : lattice_(lattice),
        face_(face),
        f_(lattice.faces_[face]),
        at_(f_.triangle),
        triangles_(triangles),
        faces_(faces),
        uv_(uv) {}

  void triangle(const Node& a, const Node& b, const Node& c) {
    faces_[at_] = face_;
    const Node* nodes[3] = {&a, &b, &c};
    for (size_t i = 0; i < 3; ++i) {
      triangles_[at_ * 3 + i] = nodes[i]->vertex;
      uv_[at_ * 3 + i] = nodes[i]->uv;
    }
    ++at_;
  }

  /// Fills the strip between two rows that run the same way, `above` to the left of `below`, always advancing
  /// on the one whose next node comes first. Node j of `above` is at fraction (offset + j) / divisions of the
  /// way.
  void strip(const std::vector<Node>& below, const std::vector<Node>& above, float offset, float divisions) {
    const auto steps = static_cast<float>(below.size() - 1);
    size_t i = 0, j = 0;
    while (i + 1 < below.size() || j + 1 < above.size()) {
      const bool advance_below =
          j + 1 == above.size() || (i + 1 < below.size() && static_cast<float>(i + 1) * divisions <=
                                                                (static_cast<float>(j + 1) + offset) * steps);
      if (advance_below) {
        triangle(below[i], below[i + 1], above[j]);
        ++i;
      } else {
        triangle(below[i], above[j + 1], above[j]);
        ++j;
      }
    }
  }

  std::vector<Node> side(uint32_t s) const {
    const Rail r = lattice_.rail(face_, s);
    std::vector<Node> nodes;
    nodes.reserve(r.rate + 1);
    for (uint32_t k = 0; k <= r.rate; ++k) {
      nodes.push_back({r.vertex(k), lattice_.side_uv(s, static_cast<float>(k) / static_cast<float>(r.rate))});
    }
    return nodes;
  }

  /// Node (i, j) of the inner lattice, from 1.
  Node inner(uint32_t i, uint32_t j) const {
    const uint32_t row =
        lattice_.topology_.triangular ? (j - 1) * (f_.nu - 1) - (j - 1) * j / 2 : (j - 1) * (f_.nu - 1);
    const uint32_t vertex = f_.inner + row + i - 1;
    return {vertex, lattice_.points_[vertex].uv};
  }

  void quad_face() {
    const uint32_t nu = f_.nu, nv = f_.nv;
    if (nu == 1 || nv == 1) {
      std::vector<Node> opposite = side(nu == 1 ? 3 : 2);
      std::reverse(opposite.begin(), opposite.end());
      strip(side(nu == 1 ? 1 : 0), opposite, 0, static_cast<float>(opposite.size() - 1));
      return;
    }
    std::vector<Node> rows[4];
    for (uint32_t i = 1; i < nu; ++i)
      rows[0].push_back(inner(i, 1)), rows[2].push_back(inner(nu - i, nv - 1));
    for (uint32_t j = 1; j < nv; ++j)
      rows[1].push_back(inner(nu - 1, j)), rows[3].push_back(inner(1, nv - j));
    for (uint32_t s = 0; s < 4; ++s) strip(side(s), rows[s], 1, static_cast<float>(s % 2 == 0 ? nu : nv));
    for (uint32_t j = 1; j + 1 < nv; ++j) {
      for (uint32_t i = 1; i + 1 < nu; ++i) {
        const Node a = inner(i, j), b = inner(i + 1, j), c = inner(i + 1, j + 1), d = inner(i, j + 1);
        triangle(a, b, d);
        triangle(b, c, d);
      }
    }
  }

  void triangle_face() {
    const uint32_t n = f_.nu;
    if (n == 1) return triangle(side(0)[0], side(1)[0], side(2)[0]);
    std::vector<Node> rows[3];
    for (uint32_t k = 1; k + 1 < n; ++k) {
      rows[0].push_back(inner(k, 1));
      rows[1].push_back(inner(n - 1 - k, k));
      rows[2].push_back(inner(1, n - 1 - k));
    }
    for (uint32_t s = 0; s < 3; ++s) strip(side(s), rows[s], 1.5f, static_cast<float>(n));
    for (uint32_t j = 1; j + 2 < n; ++j) {
      for (uint32_t i = 1; i + j + 1 < n; ++i) {
        triangle(inner(i, j), inner(i + 1, j), inner(i, j + 1));
        if (i + j + 2 < n) triangle(inner(i + 1, j), inner(i + 1, j + 1), inner(i, j + 1));
      }
    }
  }

 private:
  const SkinLattice& lattice_;
  uint32_t face_;
  const Face& f_;
  size_t at_;
  uint32_t* triangles_;
  uint32_t* faces_;
  V2f* uv_;
};

void SkinLattice::write_triangles(uint32_t face, uint32_t* triangles, uint32_t* faces, V2f* uv) const {
  if (topology_.hole[face]) return;
  Writer writer(*this, face, triangles, faces, uv);
  topology_.triangular ? writer.triangle_face() : writer.quad_face();
}

}  // namespace pelage
