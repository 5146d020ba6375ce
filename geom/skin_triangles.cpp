// SPDX-License-Identifier: Apache-2.0
// Fills the faces of a SkinLattice with triangles.
#include <algorithm>
#include <vector>

#include "geom/skin_lattice.h"

namespace pelage {

/// Writes triangles one after the other.
class SkinLattice::Writer {
 public:
  struct Node {
    uint32_t vertex;
    V2f uv;
  };

  Writer(const SkinLattice& lattice, const Face& face, uint32_t* triangles, uint32_t* faces, V2f* uv)
      : lattice_(lattice), f_(face), at_(f_.triangle), triangles_(triangles), faces_(faces), uv_(uv) {}

  void triangle(const Node& a, const Node& b, const Node& c) {
    faces_[at_] = f_.id;
    const Node* nodes[3] = {&a, &b, &c};
    for (size_t i = 0; i < 3; ++i) {
      triangles_[at_ * 3 + i] = nodes[i]->vertex;
      uv_[at_ * 3 + i] = nodes[i]->uv;
    }
    ++at_;
  }

  /// Fills the strip between two rows with the same direction, `above` to the left of `below`, always
  /// advancing on the row whose next node comes first. Node j of `above` is at the fraction (offset + j) /
  /// divisions of the way.
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
    const Rail r = lattice_.rail(f_, s);
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
  const Face& f_;
  size_t at_;
  uint32_t* triangles_;
  uint32_t* faces_;
  V2f* uv_;
};

void SkinLattice::write_triangles(size_t i, uint32_t* triangles, uint32_t* faces, V2f* uv) const {
  const Face& face = faces_[inside_[i]];
  if (is_hole(face)) return;
  Writer writer(*this, face, triangles, faces, uv);
  topology_.triangular ? writer.triangle_face() : writer.quad_face();
}

}  // namespace pelage
