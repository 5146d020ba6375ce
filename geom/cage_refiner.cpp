// SPDX-License-Identifier: Apache-2.0
#include "geom/cage_refiner.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "base/error.h"

namespace pelage {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

namespace {

/// The line of an OBJ file with the first face of more than three corners; 0 if there is none.
int first_polygon_line(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "f") continue;
    int corners = 0;
    while (words >> word && word[0] != '#') ++corners;
    if (corners > 3) return number;
  }
  return 0;
}

/// Collects the problems that prevent subdivision of a cage; the first few get their own message.
class CageChecker {
 public:
  CageChecker(const ControlMesh& mesh, SubdivisionScheme scheme, const std::string& source)
      : mesh_(mesh), scheme_(scheme), source_(source) {}

  void check() {
    if (mesh_.face_sizes.empty()) complain("the cage has no faces");
    check_faces();
    if (problems_.empty()) check_tags();
    problems_.throw_if_any();
  }

 private:
  void complain(std::string message) { problems_.add({source_, 0, 0}, std::move(message)); }

  void check_faces() {
    size_t corners = 0;
    for (uint32_t size : mesh_.face_sizes) corners += size;
    if (corners != mesh_.face_vertices.size() ||
        (!mesh_.face_uv.empty() && mesh_.face_uv.size() != mesh_.face_vertices.size())) {
      return complain(fmt::format("the faces of the cage have {} corners, but {} are given", corners,
                                  mesh_.face_vertices.size()));
    }
    std::vector<uint32_t> valence(mesh_.positions.size());
    size_t first = 0;
    for (size_t face = 0; face < mesh_.face_sizes.size(); first += mesh_.face_sizes[face], ++face) {
      check_face(face, std::span(mesh_.face_vertices).subspan(first, mesh_.face_sizes[face]), valence);
    }
    if (polygons_ > 0) complain_of_polygons();
    // Without subdivision no cost grows with the valence of a vertex.
    if (scheme_ == SubdivisionScheme::kNone) valence.clear();
    check_weights(valence);
    for (size_t v = 0; v < valence.size(); ++v) {
      if (valence[v] > SurfaceTopology::kMaxValence) {
        complain(fmt::format("{} faces meet at vertex {}; the limit is {}", valence[v], v + 1,
                             SurfaceTopology::kMaxValence));
      }
    }
    for (uint32_t index : mesh_.face_uv) {
      if (index >= mesh_.uv.size())
        return complain(fmt::format("texture coordinate {} does not exist", index + 1));
    }
  }

  /// Subdivision needs about 200 bytes times the square of each of these numbers, and triangulation as many
  /// steps: a file of megabytes could require terabytes.
  void check_weights(const std::vector<uint32_t>& valence) {
    constexpr uint64_t kFew = 16, kMaxSquares = 10'000'000;
    uint64_t squares = 0;
    for (const auto* counts : {&valence, &mesh_.face_sizes}) {
      for (uint64_t n : *counts) squares += n > kFew ? n * n : 0;
    }
    if (squares > kMaxSquares) {
      complain(
          fmt::format("too many vertices with many faces and faces with many corners: the sum of their "
                      "squares is {}, the limit is {}",
                      squares, kMaxSquares));
    }
  }

  void check_face(size_t face, std::span<const uint32_t> vertices, std::vector<uint32_t>& valence) {
    if (scheme_ == SubdivisionScheme::kLoop && vertices.size() > 3) {
      if (polygons_++ == 0) first_polygon_ = face;
      first_corners_ = polygons_ == 1 ? vertices.size() : first_corners_;
      return;
    }
    constexpr size_t kMax = SurfaceTopology::kMaxValence;
    if (vertices.size() < 3 || vertices.size() > kMax)
      return complain(
          fmt::format("face {} has {} corners; 3 to {} are supported", face + 1, vertices.size(), kMax));
    const uint32_t last = *std::max_element(vertices.begin(), vertices.end());
    if (last >= valence.size()) {
      return complain(
          fmt::format("face {} uses vertex {}, but the cage has {}", face + 1, last + 1, valence.size()));
    }
    if (distinct_corners(vertices) < 3)
      complain(fmt::format("face {} has fewer than 3 different vertices", face + 1));
    for (uint32_t v : vertices) ++valence[v];
  }

  /// One problem for all of them, at the first one in the file.
  void complain_of_polygons() {
    const std::string count = polygons_ == 1
                                  ? "1 face has"
                                  : fmt::format("{} of {} faces have", polygons_, mesh_.face_sizes.size());
    problems_.add({source_, first_polygon_line(source_), 0},
                  fmt::format("the loop scheme needs triangles, but face {} has {} corners; {} more than 3: "
                              "triangulate them or use scheme: catmull-clark",
                              first_polygon_ + 1, first_corners_, count));
  }

  static uint64_t edge_key(uint32_t a, uint32_t b) { return uint64_t(std::min(a, b)) << 32 | std::max(a, b); }

  void check_tags() {
    for (const ControlMesh::Corner& c : mesh_.corners) {
      if (c.vertex >= mesh_.positions.size())
        complain(fmt::format("corner at vertex {}: this vertex does not exist", c.vertex + 1));
    }
    for (uint32_t hole : mesh_.holes) {
      if (hole >= mesh_.face_sizes.size())
        complain(fmt::format("hole {}: this face does not exist", hole + 1));
    }
    if (mesh_.creases.empty()) return;
    std::vector<uint64_t> edges;
    size_t first = 0;
    for (uint32_t size : mesh_.face_sizes) {
      for (uint32_t i = 0; i < size; ++i) {
        edges.push_back(
            edge_key(mesh_.face_vertices[first + i], mesh_.face_vertices[first + (i + 1) % size]));
      }
      first += size;
    }
    std::sort(edges.begin(), edges.end());
    for (const ControlMesh::Crease& c : mesh_.creases) {
      if (!std::binary_search(edges.begin(), edges.end(), edge_key(c.a, c.b))) {
        complain(fmt::format("the crease from vertex {} to {} is not an edge of any face", c.a + 1, c.b + 1));
      }
    }
  }

  const ControlMesh& mesh_;
  SubdivisionScheme scheme_;
  const std::string& source_;
  size_t polygons_ = 0;  // faces that the Loop scheme does not support
  size_t first_polygon_ = 0, first_corners_ = 0;
  Problems problems_{20};
};

Sdc::Options scheme_options(const ControlMesh& mesh, BoundaryRule boundary) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(boundary == BoundaryRule::kEdgeOnly
                                          ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                          : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetCreasingMethod(mesh.chaikin_creases ? Sdc::Options::CREASE_CHAIKIN
                                                 : Sdc::Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(mesh.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH
                                                       : Sdc::Options::TRI_SUB_CATMARK);
  return options;
}

Sdc::SchemeType scheme_type(SubdivisionScheme scheme) {
  switch (scheme) {
    case SubdivisionScheme::kLoop:
      return Sdc::SCHEME_LOOP;
    case SubdivisionScheme::kBilinear:
      return Sdc::SCHEME_BILINEAR;
    default:
      return Sdc::SCHEME_CATMARK;
  }
}

}  // namespace

void check_cage(const ControlMesh& mesh, SubdivisionScheme scheme, const std::string& source) {
  CageChecker(mesh, scheme, source).check();
}

std::unique_ptr<Far::TopologyRefiner> make_refiner(const ControlMesh& mesh, SubdivisionScheme scheme,
                                                   BoundaryRule boundary, const std::string& source) {
  const std::vector<int> sizes(mesh.face_sizes.begin(), mesh.face_sizes.end());
  const std::vector<int> vertices(mesh.face_vertices.begin(), mesh.face_vertices.end());
  std::vector<int> crease_vertices, corner_vertices;
  std::vector<float> crease_sharpness, corner_sharpness;
  for (const ControlMesh::Crease& c : mesh.creases) {
    crease_vertices.insert(crease_vertices.end(), {static_cast<int>(c.a), static_cast<int>(c.b)});
    crease_sharpness.push_back(std::min(c.sharpness, Sdc::Crease::SHARPNESS_INFINITE));
  }
  for (const ControlMesh::Corner& c : mesh.corners) {
    corner_vertices.push_back(static_cast<int>(c.vertex));
    corner_sharpness.push_back(std::min(c.sharpness, Sdc::Crease::SHARPNESS_INFINITE));
  }
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(mesh.positions.size());
  descriptor.numFaces = static_cast<int>(sizes.size());
  descriptor.numVertsPerFace = sizes.data();
  descriptor.vertIndicesPerFace = vertices.data();
  descriptor.numCreases = static_cast<int>(crease_sharpness.size());
  descriptor.creaseVertexIndexPairs = crease_vertices.data();
  descriptor.creaseWeights = crease_sharpness.data();
  descriptor.numCorners = static_cast<int>(corner_sharpness.size());
  descriptor.cornerVertexIndices = corner_vertices.data();
  descriptor.cornerWeights = corner_sharpness.data();

  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(scheme_type(scheme), scheme_options(mesh, boundary))));
  if (!refiner) throw Error(ErrorKind::kInput, {source, 0, 0}, "the cage cannot be subdivided");
  return refiner;
}

}  // namespace pelage
