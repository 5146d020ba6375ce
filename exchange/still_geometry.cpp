// SPDX-License-Identifier: Apache-2.0
#include "exchange/still_geometry.h"

#include "base/memory_budget.h"
#include "geom/polygon_cut.h"

namespace pelage {
namespace {

/// Pieces of a segment of a Catmull-Rom strand. A B-spline misses its points by a sixth of their second
/// difference, which falls with the square of the number of pieces.
constexpr uint32_t kBSplinePieces = 4;

void write_ply_header(ExportedText& ply, size_t vertices, size_t faces, bool normals) {
  ply.add("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
          vertices);
  if (normals) ply.add("property float nx\nproperty float ny\nproperty float nz\n");
  ply.add("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces);
}

V3f middle(const V3f& first, const V3f& last) { return 0.5f * (first + last); }

}  // namespace

Strands still_strands(Strands strands) {
  const int keys = strands.motion_keys();
  if (keys == 1) return strands;
  StrandArrays a = std::move(strands).release();
  const size_t floats = a.points.size() / static_cast<size_t>(keys);
  const size_t before = static_cast<size_t>(keys - 1) / 2, after = static_cast<size_t>(keys) / 2;
  for (size_t i = 0; i < floats; ++i)
    a.points[i] = 0.5f * (a.points[before * floats + i] + a.points[after * floats + i]);
  a.points.resize(floats);
  a.motion_keys = 1;
  return Strands(std::move(a));
}

std::vector<float> bspline_points(const Strands& strands, size_t strand) {
  const uint32_t n = strands.strand_points(strand);
  const float* p = &strands.points()[4 * size_t{strands.first_point(strand)}];
  std::vector<float> points;
  if (strands.basis() == CurveBasis::kBSpline) return std::vector<float>(p, p + 4 * size_t{n});
  if (strands.basis() == CurveBasis::kPinnedBSpline) {
    points.assign(p, p + 4 * size_t{n});
  } else {
    const uint32_t segments = segment_count(strands.basis(), n);
    for (uint32_t i = 0; i <= segments * kBSplinePieces; ++i) {
      const uint32_t segment = std::min(i / kBSplinePieces, segments - 1);
      const float t = static_cast<float>(i - segment * kBSplinePieces) / kBSplinePieces;
      const CubicSegment curve = bezier_segment(strands, strand, segment);
      const V3f at = curve_position(curve, t);
      points.insert(points.end(), {at.x, at.y, at.z, curve_radius(curve, t)});
    }
  }
  // Phantom points, so that the curve begins and ends at its first and last point.
  const size_t last = points.size() - 4;
  float ends[8];
  for (size_t c = 0; c < 4; ++c) {
    ends[c] = 2 * points[c] - points[4 + c];
    ends[4 + c] = 2 * points[last + c] - points[last - 4 + c];
  }
  ends[3] = std::max(ends[3], 0.0f);
  ends[7] = std::max(ends[7], 0.0f);
  points.insert(points.begin(), ends, ends + 4);
  points.insert(points.end(), ends + 4, ends + 8);
  return points;
}

size_t write_ply(const std::filesystem::path& path, const FrameSkin& skin, const View& view, const Job& job) {
  size_t triangles = 0, vertices = 0;
  std::vector<SkinMesh> pieces;
  const std::vector<SkinPiece> parts = skin.posed->divide(view, 65'536, job);
  MemoryCharge charge = reserve(job.ledger, MemoryTag::kSkins, 0, "the triangles of skin " + skin.name);
  int64_t bytes = 0;
  for (const SkinPiece& piece : parts) {
    job.check_stop();
    pieces.push_back(skin.posed->tessellate(piece, view));
    bytes += static_cast<int64_t>(pieces.back().bytes());
    charge = {};
    charge = reserve(job.ledger, MemoryTag::kSkins, bytes, "the triangles of skin " + skin.name);
    vertices += pieces.back().vertex_count();
    triangles += pieces.back().triangle_count();
  }
  if (triangles == 0) return 0;
  ExportedText ply(path);
  write_ply_header(ply, vertices, triangles, true);
  for (const SkinMesh& piece : pieces) {
    const int before = (piece.motion_keys - 1) / 2, after = piece.motion_keys / 2;
    for (size_t v = 0; v < piece.vertex_count(); ++v) {
      const V3f p = middle(piece.position(v, before), piece.position(v, after));
      const V3f n = middle(piece.normal(v, before), piece.normal(v, after)).normalized();
      ply.add("{} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
  }
  uint32_t first = 0;
  for (const SkinMesh& piece : pieces) {
    for (size_t i = 0; i + 2 < piece.triangles.size(); i += 3) {
      ply.add("3 {} {} {}\n", first + piece.triangles[i], first + piece.triangles[i + 1],
              first + piece.triangles[i + 2]);
    }
    first += static_cast<uint32_t>(piece.vertex_count());
  }
  ply.commit();
  return triangles;
}

std::vector<uint32_t> cage_triangles(const ControlMesh& mesh) {
  std::vector<uint32_t> triangles, cut;
  std::vector<V3f> corners;
  const uint32_t* vertex = mesh.face_vertices.data();
  for (const uint32_t size : mesh.face_sizes) {
    corners.clear();
    cut.clear();
    for (uint32_t i = 0; i < size; ++i) corners.push_back(mesh.positions[vertex[i]]);
    cut_polygon({vertex, size}, corners, cut);
    triangles.insert(triangles.end(), cut.begin(), cut.end());
    vertex += size;
  }
  return triangles;
}

void write_ply(const std::filesystem::path& path, const ControlMesh& mesh) {
  const std::vector<uint32_t> triangles = cage_triangles(mesh);
  ExportedText ply(path);
  write_ply_header(ply, mesh.positions.size(), triangles.size() / 3, false);
  for (const V3f& p : mesh.positions) ply.add("{} {} {}\n", p.x, p.y, p.z);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3)
    ply.add("3 {} {} {}\n", triangles[i], triangles[i + 1], triangles[i + 2]);
  ply.commit();
}

}  // namespace pelage
