// SPDX-License-Identifier: Apache-2.0
#include "geom/skin_lattice.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"

namespace pelage {

namespace {

constexpr uint64_t kMaxElements = std::numeric_limits<int32_t>::max();
constexpr size_t kItemsPerCheck = 4096;

void sort_unique(std::vector<uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::vector<uint32_t> all_faces(const SurfaceTopology::Impl& topology) {
  std::vector<uint32_t> faces(topology.cage_face.size());
  std::iota(faces.begin(), faces.end(), 0u);
  return faces;
}

}  // namespace

uint32_t SkinLattice::Rail::vertex(uint32_t k) const {
  const uint32_t position = step > 0 ? base + k : base - k;
  if (position == 0) return line->start;
  return position == line->rate ? line->end : line->inner + position - 1;
}

SkinLattice::SkinLattice(const SurfaceTopology::Impl& topology, const CheckStop& check_stop)
    : SkinLattice(topology, all_faces(topology), all_faces(topology), check_stop) {}

SkinLattice::SkinLattice(const SurfaceTopology::Impl& topology, std::span<const uint32_t> faces,
                         std::span<const uint32_t> around, const CheckStop& check_stop)
    : topology_(topology) {
  find_lines(faces, check_stop);
  faces_.reserve(around.size());
  inside_.reserve(faces.size());
  size_t next = 0;
  for (const uint32_t id : around) {
    if (faces_.size() % kItemsPerCheck == 0) check_stop();
    Face face{id, {kNone, kNone, kNone, kNone}};
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
      const uint32_t wanted = line_id(id, side);
      // When all lines before it are present, as in a whole skin, the index of a line is its number.
      const bool there = wanted < lines_.size() && lines_[wanted].id == wanted;
      const auto found =
          there ? lines_.begin() + wanted
                : std::lower_bound(lines_.begin(), lines_.end(), wanted,
                                   [](const Line& line, uint32_t value) { return line.id < value; });
      if (found == lines_.end() || found->id != wanted) continue;
      face.line[side] = static_cast<uint32_t>(found - lines_.begin());
      const bool is_half = is_edge(wanted) && is_part(id);
      found->halved = found->halved || is_half;
      if (found->face != kNone || topology_.hole[id]) continue;
      found->face = id;
      found->side = side;
      found->is_half = is_half;
    }
    if (next < faces.size() && faces[next] == id) {
      inside_.push_back(static_cast<uint32_t>(faces_.size()));
      ++next;
    }
    faces_.push_back(face);
  }
}

/// The lines of all `faces` that are not holes, ascending.
std::vector<uint32_t> SkinLattice::line_ids(std::span<const uint32_t> faces,
                                            const CheckStop& check_stop) const {
  std::vector<uint32_t> ids;
  // For many faces, marking among all lines is faster than sorting.
  const size_t all = topology_.cage.edge_count() + topology_.cage_face.size();
  std::vector<bool> seen(faces.size() > topology_.cage_face.size() / 8 ? all : 0);
  if (seen.empty()) ids.reserve(faces.size() * topology_.corners_per_face());
  size_t done = 0, count = 0;
  for (const uint32_t face : faces) {
    if (done++ % kItemsPerCheck == 0) check_stop();
    if (topology_.hole[face]) continue;
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
      const uint32_t id = line_id(face, side);
      if (seen.empty()) {
        ids.push_back(id);
      } else if (!seen[id]) {
        seen[id] = true;
        ++count;
      }
    }
  }
  if (seen.empty()) {
    sort_unique(ids);
    return ids;
  }
  ids.reserve(count);
  for (uint32_t id = 0; id < all; ++id) {
    if (seen[id]) ids.push_back(id);
  }
  return ids;
}

/// Finds the lines of all `faces` that are not holes, and the cage vertices at their ends.
void SkinLattice::find_lines(std::span<const uint32_t> faces, const CheckStop& check_stop) {
  const std::vector<uint32_t> ids = line_ids(faces, check_stop);
  lines_.resize(ids.size());
  const bool many = ids.size() > topology_.cage.edge_count() / 8;
  std::vector<bool> seen(many ? topology_.control_count : 0);
  for (size_t i = 0; i < ids.size(); ++i) {
    if (i % kItemsPerCheck == 0) check_stop();
    lines_[i].id = ids[i];
    if (!is_edge(ids[i])) continue;
    const uint32_t* ends = &topology_.cage.edge_vertices[size_t(ids[i]) * 2];
    for (int end = 0; end < 2; ++end) {
      if (many)
        seen[ends[end]] = true;
      else
        cage_vertices_.push_back(ends[end]);
    }
  }
  if (!many) return sort_unique(cage_vertices_);
  for (uint32_t vertex = 0; vertex < seen.size(); ++vertex) {
    if (seen[vertex]) cage_vertices_.push_back(vertex);
  }
}

void SkinLattice::take_rates(const SkinLattice& whole) {
  auto from = whole.lines_.begin();
  for (Line& line : lines_) {
    from = std::lower_bound(from, whole.lines_.end(), line.id,
                            [](const Line& other, uint32_t id) { return other.id < id; });
    line.rate = from->rate;
  }
}

uint32_t SkinLattice::line_id(uint32_t face, uint32_t side) const {
  const CageConnectivity& cage = topology_.cage;
  const uint32_t whole = topology_.cage_face[face];
  const uint32_t* edges = &cage.corner_edge[cage.first_corner[whole]];
  if (!is_part(face)) return edges[side];
  const uint32_t first = cage.first_ptex[whole], n = cage.face_size(whole);
  const uint32_t corner = face - first, before = (corner + n - 1) % n;
  switch (side) {
    case 0:
      return edges[corner];
    case 1:
      return cage.edge_count() + face;
    case 2:
      return cage.edge_count() + first + before;
    default:
      return edges[before];
  }
}

/// The cage vertex at the start of a side of a ptex face; kNone where it starts at the middle of an edge or
/// of a face.
uint32_t SkinLattice::corner_vertex(uint32_t face, uint32_t side) const {
  const CageConnectivity& cage = topology_.cage;
  const uint32_t whole = topology_.cage_face[face];
  if (!is_part(face)) return cage.corner_vertex[cage.first_corner[whole] + side];
  return side == 0 ? cage.corner_vertex[cage.first_corner[whole] + face - cage.first_ptex[whole]] : kNone;
}

/// Index of a cage vertex in cage_vertices_, or kNone.
uint32_t SkinLattice::place_of(uint32_t cage_vertex) const {
  if (cage_vertex < cage_vertices_.size() && cage_vertices_[cage_vertex] == cage_vertex) return cage_vertex;
  const auto found = std::lower_bound(cage_vertices_.begin(), cage_vertices_.end(), cage_vertex);
  if (found == cage_vertices_.end() || *found != cage_vertex) return kNone;
  return static_cast<uint32_t>(found - cage_vertices_.begin());
}

SkinLattice::Rail SkinLattice::rail(const Face& f, uint32_t side) const {
  const CageConnectivity& cage = topology_.cage;
  const Line& line = lines_[f.line[side]];
  if (!is_edge(line.id)) {
    return side == 1 ? Rail{&line, 0, 1, line.rate} : Rail{&line, line.rate, -1, line.rate};
  }
  // Edges have one direction, the faces around them use both.
  const uint32_t whole = topology_.cage_face[f.id], n = cage.face_size(whole);
  const bool split = is_part(f.id);
  const uint32_t corner = split ? f.id - cage.first_ptex[whole] : side;
  const uint32_t from = split && side == 3 ? (corner + n - 1) % n : corner;
  const bool forward =
      cage.corner_vertex[cage.first_corner[whole] + from] == cage.edge_vertices[size_t(line.id) * 2];
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
  const uint64_t first = vertex_count_;
  vertex_count_ += count;
  if (vertex_count_ > kMaxElements) {
    throw Error(ErrorKind::kMemory, "a tessellated skin would have more than 2147483647 vertices");
  }
  return static_cast<uint32_t>(first);
}

void SkinLattice::number_line(uint32_t index) {
  Line& line = lines_[index];
  if (line.inner != kNone) return;
  line.inner = new_points(line.rate - 1);
  if (is_edge(line.id)) {
    for (size_t end = 0; end < 2; ++end) {
      uint32_t& vertex = numbers_[place_of(topology_.cage.edge_vertices[size_t(line.id) * 2 + end])];
      if (vertex == kNone) vertex = new_points(1);
      (end == 0 ? line.start : line.end) = vertex;
    }
    return;
  }
  // The centre belongs to the n-gon's first spoke, which is numbered before the others. All spokes of an
  // n-gon are consecutive.
  const uint32_t owner = line.id - topology_.cage.edge_count();
  const uint32_t first = index - (owner - topology_.cage.first_ptex[topology_.cage_face[owner]]);
  if (lines_[first].end == kNone) lines_[first].end = new_points(1);
  line.end = lines_[first].end;
}

void SkinLattice::divide(Face& f) {
  uint64_t rates[4] = {0, 0, 0, 0}, sum = 0;
  for (uint32_t side = 0; side < topology_.corners_per_face(); ++side)
    sum += rates[side] = rail(f, side).rate;
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
  if (triangle_count_ > kMaxElements) {
    throw Error(ErrorKind::kMemory, "a tessellated skin would have more than 2147483647 triangles");
  }
}

/// Places the vertices on the sides of a face that no previous face has placed. If the face has no triangles
/// here, places only the vertices that it shares with faces that have some.
void SkinLattice::place_rails(const Face& f) {
  const auto place = [&](uint32_t vertex, V2f uv) {
    if (points_[vertex].face == kNone) points_[vertex] = {f.id, uv};
  };
  for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
    if (f.line[side] == kNone) {
      const uint32_t corner = corner_vertex(f.id, side);
      const uint32_t at = corner == kNone ? kNone : place_of(corner);
      if (at != kNone) place(numbers_[at], side_uv(side, 0));
      continue;
    }
    const Rail r = rail(f, side);
    for (uint32_t k = 0; k <= r.rate; ++k)
      place(r.vertex(k), side_uv(side, static_cast<float>(k) / static_cast<float>(r.rate)));
  }
}

void SkinLattice::place_inner(const Face& f) {
  const float du = 1.0f / static_cast<float>(f.nu), dv = 1.0f / static_cast<float>(f.nv);
  uint32_t vertex = f.inner;
  for (uint32_t j = 1; j < f.nv; ++j) {
    const uint32_t end = topology_.triangular ? f.nu - j : f.nu;
    for (uint32_t i = 1; i < end; ++i) {
      points_[vertex++] = {f.id, V2f(static_cast<float>(i) * du, static_cast<float>(j) * dv)};
    }
  }
}

void SkinLattice::number(const CheckStop& check_stop) {
  numbers_.assign(cage_vertices_.size(), kNone);
  size_t numbered = 0;
  vertex_count_ = triangle_count_ = 0;
  for (Line& line : lines_) line.start = line.end = line.inner = kNone;
  for (const uint32_t inside : inside_) {
    if (numbered++ % kItemsPerCheck == 0) check_stop();
    Face& face = faces_[inside];
    face.triangle = static_cast<uint32_t>(triangle_count_);
    if (is_hole(face)) continue;
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) number_line(face.line[side]);
    divide(face);
  }
  // Spokes start in the middle of an edge, whose vertices already exist.
  for (const uint32_t inside : inside_) {
    const Face& face = faces_[inside];
    if (is_hole(face) || !is_part(face.id)) continue;
    const Rail half = rail(face, 0);
    lines_[face.line[1]].start = half.vertex(half.rate);
  }
}

void SkinLattice::place() {
  points_.assign(vertex_count_, {kNone, V2f(0)});
  for (const Face& face : faces_) {
    if (!is_hole(face)) place_rails(face);
  }
  for (const uint32_t inside : inside_) {
    if (!is_hole(faces_[inside])) place_inner(faces_[inside]);
  }
}

void SkinLattice::visit_split(const std::function<void(uint32_t, const LatticePoint&)>& visit) const {
  const CageConnectivity& cage = topology_.cage;
  for (const Face& face : faces_) {
    if (is_hole(face)) continue;
    for (uint32_t side = 0; side < topology_.corners_per_face(); ++side) {
      // Skips each side's last node, because it is the first node of the next side: each face counts once per
      // vertex.
      const uint32_t corner = corner_vertex(face.id, side);
      if (corner != kNone && cage.vertex_split[corner]) {
        const uint32_t at = place_of(corner);
        if (at != kNone) visit(numbers_[at], {face.id, side_uv(side, 0)});
      }
      const uint32_t line = face.line[side];
      if (line == kNone || !is_edge(lines_[line].id) || !cage.edge_split[lines_[line].id]) continue;
      const Rail r = rail(face, side);
      for (uint32_t k = corner == kNone ? 0 : 1; k < r.rate; ++k) {
        visit(r.vertex(k), {face.id, side_uv(side, static_cast<float>(k) / static_cast<float>(r.rate))});
      }
    }
  }
}

size_t SkinLattice::bytes_bound(size_t around, size_t vertices) {
  // Every face has at most four lines and corners of its own; vectors may have grown by doubling.
  constexpr size_t kPerFace = sizeof(Face) + 4 * (sizeof(Line) + 7 * sizeof(uint32_t));
  return sizeof(SkinLattice) + around * kPerFace + vertices * sizeof(LatticePoint);
}

}  // namespace pelage
