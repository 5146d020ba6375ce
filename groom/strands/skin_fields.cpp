// SPDX-License-Identifier: Apache-2.0
#include "groom/strands/skin_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/ledger.h"
#include "base/memory_budget.h"
#include "geom/cage_values.h"
#include "geom/closest_point.h"
#include "groom/strands/named_mesh.h"
#include "image/field.h"

namespace pelage {
namespace {

using Range = std::pair<float, float>;

/// Values at the vertices of the cage.
struct VertexValues final : SkinValues {
  VertexValues(CageValues v, Range r, MemoryLedger& ledger)
      : values(std::move(v)),
        limits(r),
        charge(ledger, MemoryTag::kGrooms, static_cast<int64_t>(values.bytes())) {}
  Rgb at(const FieldPoint& p) const override { return values.at(p.face, p.face_uv.x, p.face_uv.y); }
  Range range() const override { return limits; }

  CageValues values;
  Range limits;
  MemoryCharge charge;
};

std::shared_ptr<const SkinValues> vertex_values(const LimitSurface& rest, std::vector<Rgb> values,
                                                MemoryLedger& ledger) {
  Range limits{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
  for (const Rgb& value : values) {
    for (int c = 0; c < 3; ++c)
      limits = {std::min(limits.first, value[c]), std::max(limits.second, value[c])};
  }
  return std::make_shared<const VertexValues>(CageValues(rest.shared_topology(), std::move(values)), limits,
                                              ledger);
}

/// 1 on some faces.
struct FaceMask final : SkinValues {
  FaceMask(std::vector<bool> faces, MemoryLedger& ledger)
      : inside(std::move(faces)),
        charge(ledger, MemoryTag::kGrooms, static_cast<int64_t>(inside.capacity() / 8)) {}
  Rgb at(const FieldPoint& p) const override { return Rgb(inside[p.face] ? 1.0f : 0.0f); }
  Range range() const override { return {0, 1}; }

  std::vector<bool> inside;  // by ptex face
  MemoryCharge charge;
};

/// Distance from triangles, which may be lines: two of their corners are then the same.
struct TriangleDistance final : SkinValues {
  TriangleDistance(SkinMesh m, const Box3f& skin, const Job& job)
      : mesh(std::move(m)),
        tree(mesh, 0, &job),
        charge(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(mesh.bytes() + tree.bytes())) {
    Box3f both = skin;
    for (size_t v = 0; v < mesh.vertex_count(); ++v) both.extendBy(mesh.position(v));
    farthest = both.size().length() * 1.0001f;
  }
  Rgb at(const FieldPoint& p) const override {
    ClosestPoint nearest;
    const bool found = tree.closest_position(p.rest, std::numeric_limits<float>::infinity(), nearest);
    return Rgb(found ? std::min(nearest.distance, farthest) : farthest);
  }
  Range range() const override { return {0.0f, farthest}; }

  SkinMesh mesh;
  ClosestPointTree tree;
  float farthest = 0;
  MemoryCharge charge;
};

void add_vertex(const V3f& p, SkinMesh& mesh) {
  mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
  mesh.normals.insert(mesh.normals.end(), {0, 0, 0});
}

/// Adds the part of the line where a field is 0.5 in a triangle between grid points.
void add_crossing(const FieldPoint* const corners[3], const float values[3], SkinMesh& lines) {
  V3f ends[3];
  size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    const float a = values[i] - 0.5f, b = values[(i + 1) % 3] - 0.5f;
    if ((a < 0) == (b < 0)) continue;
    ends[count++] = corners[i]->rest + (corners[(i + 1) % 3]->rest - corners[i]->rest) * (a / (a - b));
  }
  if (count != 2) return;
  const auto first = static_cast<uint32_t>(lines.vertex_count());
  add_vertex(ends[0], lines);
  add_vertex(ends[1], lines);
  lines.triangles.insert(lines.triangles.end(), {first, first + 1, first + 1});
}

/// Whether a name is one of the words of a group's name, which may list several groups, or the whole name.
bool names_group(const std::string& all, const std::string& name) {
  if (all == name) return true;
  std::istringstream words(all);
  for (std::string word; words >> word;) {
    if (word == name) return true;
  }
  return false;
}

}  // namespace

SkinFields::SkinFields(std::string name, const LimitSurface& rest, const ControlMesh& cage, const Job& job)
    : name_(std::move(name)), rest_(rest), cage_(cage), job_(job) {}

ContentHash SkinFields::attributes_hash() const {
  ContentHasher hasher;
  for (const Rgb& color : cage_.colors) hasher.add(color.x).add(color.y).add(color.z);
  const auto add = [&](const std::vector<std::string>& names, const std::vector<uint16_t>& faces) {
    hasher.add(static_cast<uint64_t>(names.size()));
    for (const std::string& name : names) hasher.add(name);
    hasher.add_bytes(std::as_bytes(std::span(faces)));
  };
  add(cage_.groups, cage_.face_groups);
  add(cage_.objects.names, cage_.objects.faces);
  add(cage_.materials.names, cage_.materials.faces);
  return hasher.digest();
}

std::vector<std::string> SkinFields::groups() const {
  std::vector<std::string> found;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
  };
  for (const std::string& group : cage_.groups) {
    std::istringstream words(group);
    for (std::string word; words >> word;) add(word);
    add(group);
  }
  for (const std::string& name : cage_.objects.names) add(name);
  for (const std::string& name : cage_.materials.names) add(name);
  return found;
}

std::shared_ptr<const SkinValues> SkinFields::group(const std::string& name) const {
  const SurfaceTopology& topology = rest_.topology();
  std::vector<bool> inside(topology.face_count());
  const auto mark = [&](const std::vector<std::string>& names, const std::vector<uint16_t>& faces) {
    std::vector<bool> named;
    for (const std::string& other : names) named.push_back(names_group(other, name));
    for (uint32_t face = 0; face < inside.size() && !faces.empty(); ++face) {
      if (named[faces[topology.cage_face(face)]]) inside[face] = true;
    }
  };
  mark(cage_.groups, cage_.face_groups);
  mark(cage_.objects.names, cage_.objects.faces);
  mark(cage_.materials.names, cage_.materials.faces);
  return std::make_shared<const FaceMask>(std::move(inside), job_.ledger);
}

std::shared_ptr<const SkinValues> SkinFields::vertex_colors() const {
  if (cage_.colors.empty()) return nullptr;
  return vertex_values(rest_, cage_.colors, job_.ledger);
}

std::shared_ptr<const SkinValues> SkinFields::curvature() const {
  std::vector<Rgb> values;
  for (const float curvature : vertex_curvatures(rest_)) values.emplace_back(curvature);
  return vertex_values(rest_, std::move(values), job_.ledger);
}

std::shared_ptr<const SkinValues> SkinFields::distance_to_boundary(const Field& region) const {
  constexpr double kCells = 1e6;
  const SurfaceTopology& topology = rest_.topology();
  const auto n = static_cast<size_t>(
      std::clamp(std::sqrt(kCells / std::max<double>(1, topology.face_count())), 2.0, 64.0));
  const FieldDependence needs = region.dependence();
  std::vector<FieldPoint> points((n + 1) * (n + 1));
  std::vector<float> values(points.size());
  SkinMesh lines;
  for (uint32_t face = 0; face < topology.face_count(); ++face) {
    if (face % 256 == 0) job_.check_stop();
    if (topology.is_hole(face)) continue;
    for (size_t i = 0; i < points.size(); ++i) {
      const float u = static_cast<float>(i % (n + 1)) / static_cast<float>(n),
                  v = static_cast<float>(i / (n + 1)) / static_cast<float>(n);
      if (topology.is_triangular() && u + v > 1.0001f) continue;
      FieldPoint& p = points[i];
      const SurfacePoint at = rest_.evaluate(face, u, v);
      const V2f uv = topology.texture_coordinates(face, u, v);
      p.rest = at.position;
      p.u = uv.x;
      p.v = uv.y;
      p.face = face;
      p.face_uv = {u, v};
      if (needs.normal) p.normal = rest_.frame(at, face, u, v).normal;
      values[i] = region.value(p);
    }
    const auto add = [&](size_t a, size_t b, size_t c) {
      const FieldPoint* const corners[3] = {&points[a], &points[b], &points[c]};
      const float at[3] = {values[a], values[b], values[c]};
      add_crossing(corners, at, lines);
    };
    for (size_t row = 0; row < n; ++row) {
      for (size_t column = 0; column < n; ++column) {
        if (topology.is_triangular() && row + column >= n) break;
        const size_t corner = row * (n + 1) + column, above = corner + n + 1;
        add(corner, corner + 1, above);
        if (!topology.is_triangular() || row + column + 1 < n) add(corner + 1, above + 1, above);
      }
    }
  }
  if (lines.triangles.empty()) return nullptr;
  return std::make_shared<const TriangleDistance>(std::move(lines), bounds(), job_);
}

std::shared_ptr<const SkinValues> SkinFields::distance_to_mesh(const AssetPath& file) const {
  return std::make_shared<const TriangleDistance>(read_named_mesh(file, job_), bounds(), job_);
}

}  // namespace pelage
