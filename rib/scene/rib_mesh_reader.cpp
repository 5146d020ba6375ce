// SPDX-License-Identifier: Apache-2.0
#include "rib/scene/rib_mesh_reader.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "geom/rest_position.h"

namespace pelage {
namespace {

const std::vector<int64_t>& integers(const RibStatement& request, size_t index) {
  if (index >= request.arguments.size()) request.fail(fmt::format("argument {} is missing", index + 1));
  const RibOperand& a = request.arguments[index];
  if (a.kind != RibOperand::Kind::kIntegers && a.size() > 0)
    request.fail(a, "expected an array of integers, got " + a.describe());
  return a.integers;
}

/// Converts one request.
class MeshReader {
 public:
  MeshReader(RibStatement& request, const RibDeclarations& declarations)
      : request_(request), declarations_(declarations) {}

  RibMesh read() {
    size_t parameters = 0;
    if (request_.name.ends_with("SubdivisionMesh")) {
      parameters = read_subdivision();
    } else if (request_.name == "PointsGeneralPolygons") {
      read_loops(integers(request_, 0), integers(request_, 1), integers(request_, 2));
      parameters = 3;
    } else if (request_.name == "GeneralPolygon") {
      const std::vector<int64_t>& sizes = integers(request_, 0);
      std::vector<int64_t> vertices;
      for (const int64_t size : sizes) {
        for (int64_t i = 0; i < size && vertices.size() < kMaxPolygon; ++i)
          vertices.push_back(static_cast<int64_t>(vertices.size()));
      }
      read_loops({static_cast<int64_t>(sizes.size())}, sizes, vertices);
      parameters = 1;
    } else if (request_.name == "PointsPolygons") {
      add_faces(integers(request_, 0), integers(request_, 1));
      parameters = 2;
    }
    std::vector<std::string> undeclared;
    parameters_ = declarations_.parameters(request_, parameters, undeclared);
    project_points(request_, parameters_);
    mesh_.samples.push_back(positions(request_, parameters_, "P"));
    ControlMesh& cage = mesh_.cage;
    cage.positions = mesh_.samples.front();
    if (request_.name == "Polygon") {
      cage.face_sizes = {static_cast<uint32_t>(cage.positions.size())};
      cage.face_vertices.resize(cage.positions.size());
      std::iota(cage.face_vertices.begin(), cage.face_vertices.end(), 0u);
    }
    if (find_parameter(parameters_, "Cs")) mesh_.ignored.emplace_back("parameter 'Cs' of a mesh");
    add_rest();
    check_faces();
    add_texture_coordinates();
    add_tags();
    drop_flat_faces();
    return std::move(mesh_);
  }

  static std::vector<V3f> positions(RibStatement& request, const std::vector<RibNamedValue>& parameters,
                                    const char* name) {
    const RibNamedValue* p = find_parameter(parameters, name);
    if (!p || p->declaration.components != 3 || !p->value->is_number() || p->value->size() % 3 != 0)
      request.fail(fmt::format("parameter \"{}\" must be an array of points", name));
    std::vector<V3f> points(p->value->size() / 3);
    for (size_t i = 0; i < points.size(); ++i) {
      const auto& f = p->value->floats;
      points[i] = V3f(f[3 * i], f[3 * i + 1], f[3 * i + 2]);
      for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(points[i][axis]) || std::abs(points[i][axis]) > 1e18f)
          request.fail(*p->value, fmt::format("point {} is not finite or beyond 1e18", i));
      }
    }
    return points;
  }

 private:
  size_t read_subdivision() {
    if (request_.arguments.empty() || request_.arguments[0].is_number())
      request_.fail("expected the name of a scheme");
    const std::string& scheme = request_.arguments[0].strings[0];
    if (scheme == "catmull-clark") {
      mesh_.scheme = SubdivisionScheme::kCatmullClark;
    } else if (scheme == "loop") {
      mesh_.scheme = SubdivisionScheme::kLoop;
    } else if (scheme == "bilinear") {
      mesh_.scheme = SubdivisionScheme::kBilinear;
    } else {
      request_.fail(request_.arguments[0], "unknown scheme " + quote(scheme) +
                                               "; expected \"catmull-clark\", \"loop\" or \"bilinear\"");
    }
    add_faces(integers(request_, 1), integers(request_, 2));
    // Tags are optional: a string here is the first parameter.
    const auto& a = request_.arguments;
    const bool tags = a.size() > 3 && a[3].is_array;
    return !tags ? 3 : hierarchical() ? 8 : 7;
  }

  // Other renderers may have "Pref" of other classes for their shaders; these are not needed here.
  void add_rest() {
    const RibNamedValue* rest = find_parameter(parameters_, kRestPositions);
    if (!rest || rest->declaration.frequency != RibClass::kVertex || rest->declaration.components != 3)
      return;
    mesh_.rest = positions(request_, parameters_, "Pref");
    if (mesh_.rest.size() != mesh_.cage.positions.size())
      request_.fail(*rest->value, fmt::format("parameter \"Pref\" needs {} points for this mesh, got {}",
                                              mesh_.cage.positions.size(), mesh_.rest.size()));
  }

  // A polygon with holes has several loops; the first one is its outline.
  void read_loops(const std::vector<int64_t>& loops, const std::vector<int64_t>& sizes,
                  const std::vector<int64_t>& vertices) {
    std::vector<int64_t> outer_sizes, outer_vertices;
    size_t loop = 0, vertex = 0;
    for (const int64_t count : loops) {
      if (count < 1 || static_cast<uint64_t>(count) > sizes.size() - loop)
        request_.fail("the numbers of loops and of their vertices do not agree");
      for (int64_t i = 0; i < count; ++i, ++loop) {
        if (sizes[loop] < 0 || static_cast<uint64_t>(sizes[loop]) > vertices.size() - vertex)
          request_.fail("there are fewer vertices than the loops need");
        const auto begin = vertices.begin() + static_cast<ptrdiff_t>(vertex);
        vertex += static_cast<size_t>(sizes[loop]);
        if (i > 0) {
          mesh_.ignored.emplace_back("holes in polygons");
          continue;
        }
        outer_sizes.push_back(sizes[loop]);
        outer_vertices.insert(outer_vertices.end(), begin, begin + static_cast<ptrdiff_t>(sizes[loop]));
        for (size_t corner = vertex - static_cast<size_t>(sizes[loop]); corner < vertex; ++corner)
          corner_.push_back(corner);
      }
    }
    corners_in_file_ = vertices.size();
    add_faces(outer_sizes, outer_vertices);
  }

  void add_faces(const std::vector<int64_t>& sizes, const std::vector<int64_t>& vertices) {
    uint64_t corners = 0;
    for (const int64_t size : sizes) {
      if (size < 0 || size > kMaxPolygon) request_.fail(fmt::format("a face has {} vertices", size));
      mesh_.cage.face_sizes.push_back(static_cast<uint32_t>(size));
      corners += static_cast<uint64_t>(size);
    }
    if (corners != vertices.size())
      request_.fail(
          fmt::format("the faces have {} vertices together, but {} are given", corners, vertices.size()));
    for (const int64_t vertex : vertices) {
      if (vertex < 0 || vertex >= int64_t(1) << 31)
        request_.fail(fmt::format("a face has vertex {}, which does not exist", vertex));
      mesh_.cage.face_vertices.push_back(static_cast<uint32_t>(vertex));
    }
    if (corners_in_file_ == 0) corners_in_file_ = vertices.size();
  }

  void check_faces() {
    ControlMesh& cage = mesh_.cage;
    size_t corner = 0;
    for (size_t face = 0; face < cage.face_sizes.size(); ++face) {
      const std::span vertices(&cage.face_vertices[corner], cage.face_sizes[face]);
      corner += vertices.size();
      for (const uint32_t vertex : vertices) {
        if (vertex >= cage.positions.size())
          request_.fail(fmt::format("face {} has vertex {}, but there are only {} points", face, vertex,
                                    cage.positions.size()));
      }
    }
  }

  /// Faces with fewer than 3 different vertices, which exporters write for edges and collapsed corners.
  void drop_flat_faces() {
    ControlMesh& cage = mesh_.cage;
    const auto is_flat = [](const ControlMesh& mesh, size_t first, uint32_t size) {
      return distinct_corners(std::span(mesh.face_vertices).subspan(first, size)) < 3;
    };
    bool any = false;
    size_t first = 0;
    for (const uint32_t size : cage.face_sizes) any |= is_flat(cage, first, size), first += size;
    if (!any) return;
    mesh_.ignored.emplace_back("faces with fewer than 3 different vertices");
    const ControlMesh before = cage;
    std::vector<uint32_t> number;  // of each face that is kept, among those kept; kDropped for the others
    cage.face_sizes.clear(), cage.face_vertices.clear(), cage.face_uv.clear(), cage.holes.clear();
    first = 0;
    for (const uint32_t size : before.face_sizes) {
      const auto begin = static_cast<ptrdiff_t>(first), end = begin + static_cast<ptrdiff_t>(size);
      const bool flat = is_flat(before, first, size);
      first += size;
      if (flat) {
        number.push_back(kDropped);
        continue;
      }
      number.push_back(static_cast<uint32_t>(cage.face_sizes.size()));
      cage.face_sizes.push_back(size);
      cage.face_vertices.insert(cage.face_vertices.end(), before.face_vertices.begin() + begin,
                                before.face_vertices.begin() + end);
      if (!before.face_uv.empty())
        cage.face_uv.insert(cage.face_uv.end(), before.face_uv.begin() + begin, before.face_uv.begin() + end);
    }
    for (const uint32_t hole : before.holes) {
      if (number[hole] != kDropped) cage.holes.push_back(number[hole]);
    }
  }

  void add_texture_coordinates() {
    const RibNamedValue *st = find_parameter(parameters_, "st"), *s = find_parameter(parameters_, "s"),
                        *t = find_parameter(parameters_, "t");
    if (st && st->declaration.components == 2) {
      add_uv(*st, *st, 2, 1);
    } else if (s && t && s->declaration.components == 1 && t->declaration.components == 1 &&
               s->declaration.frequency == t->declaration.frequency) {
      add_uv(*s, *t, 1, 0);
    }
  }

  void add_uv(const RibNamedValue& s, const RibNamedValue& t, size_t stride, size_t offset) {
    const RibClass frequency = s.declaration.frequency;
    if (frequency == RibClass::kConstant || frequency == RibClass::kUniform) return;
    const bool per_corner = frequency == RibClass::kFaceVarying;
    ControlMesh& cage = mesh_.cage;
    const size_t values =
        per_corner ? std::max(corners_in_file_, cage.face_vertices.size()) : cage.positions.size();
    for (const RibNamedValue* p : {&s, &t}) {
      if (p->value->size() == values * stride) continue;
      mesh_.ignored.push_back(fmt::format("parameter {} with {} numbers for a mesh that needs {}",
                                          quote(p->name), p->value->size(), values * stride));
      return;
    }
    for (size_t i = 0; i < values; ++i) {
      const V2f uv(s.value->number(stride * i), t.value->number(stride * i + offset));
      cage.uv.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : V2f(0));
    }
    if (!per_corner) {
      cage.face_uv = cage.face_vertices;
      return;
    }
    for (size_t corner = 0; corner < cage.face_vertices.size(); ++corner)
      cage.face_uv.push_back(static_cast<uint32_t>(corner_.empty() ? corner : corner_[corner]));
  }

  void add_tags() {
    const auto& a = request_.arguments;
    if (mesh_.scheme == SubdivisionScheme::kNone || a.size() <= 3 || !a[3].is_array) return;
    const size_t kinds = hierarchical() ? 3 : 2;  // integers, floats and strings
    if (a.size() < 5 + kinds)
      request_.fail("tags need arrays of names, counts, integers and floats" +
                    std::string(hierarchical() ? ", and strings" : ""));
    const std::vector<int64_t>&counts = integers(request_, 4), &whole = integers(request_, 5);
    const RibOperand& floats = a[6];
    if (!floats.is_number()) request_.fail(floats, "expected an array of floats, got " + floats.describe());
    size_t i = 0, f = 0, t = 0;
    for (size_t tag = 0; tag < a[3].size(); ++tag) {
      if (a[3].is_number()) request_.fail(a[3], "expected the names of tags");
      if (counts.size() < kinds * (tag + 1))
        request_.fail(a[4], fmt::format("each tag needs {} counts", kinds));
      const int64_t ni = counts[kinds * tag], nf = counts[kinds * tag + 1],
                    nt = hierarchical() ? counts[kinds * tag + 2] : 0;
      if (ni < 0 || nf < 0 || nt < 0 || static_cast<uint64_t>(ni) > whole.size() - i ||
          static_cast<uint64_t>(nf) > floats.size() - f ||
          static_cast<uint64_t>(nt) > (nt > 0 ? a[7].strings.size() - t : 0))
        request_.fail(a[4],
                      fmt::format("tag {} has more arguments than are given", quote(a[3].strings[tag])));
      std::vector<float> numbers;
      for (size_t k = 0; k < static_cast<size_t>(nf); ++k) numbers.push_back(floats.number(f + k));
      if (a[3].strings[tag] == "creasemethod") {
        mesh_.cage.chaikin_creases = nt > 0 && a[7].strings[t] == "chaikin";
      } else {
        add_tag(a[3].strings[tag], std::span(whole).subspan(i, static_cast<size_t>(ni)), numbers);
      }
      i += static_cast<size_t>(ni);
      f += static_cast<size_t>(nf);
      t += static_cast<size_t>(nt);
    }
  }

  void add_tag(const std::string& name, std::span<const int64_t> whole, const std::vector<float>& floats) {
    ControlMesh& cage = mesh_.cage;
    const auto index = [&](int64_t value, size_t count) {
      if (value < 0 || static_cast<uint64_t>(value) >= count)
        request_.fail(fmt::format("tag {} has index {}, which does not exist", quote(name), value));
      return static_cast<uint32_t>(value);
    };
    const size_t points = cage.positions.size();
    if (name == "crease") {
      for (size_t k = 0; k + 1 < whole.size() && !floats.empty(); ++k)
        cage.creases.push_back({index(whole[k], points), index(whole[k + 1], points),
                                floats.size() + 1 == whole.size() ? floats[k] : floats[0]});
    } else if (name == "corner") {
      for (size_t k = 0; k < whole.size() && !floats.empty(); ++k)
        cage.corners.push_back(
            {index(whole[k], points), floats.size() == whole.size() ? floats[k] : floats[0]});
    } else if (name == "hole") {
      for (const int64_t face : whole) cage.holes.push_back(index(face, cage.face_sizes.size()));
    } else if (name == "interpolateboundary") {
      const int64_t rule = whole.empty() ? 1 : whole[0];
      mesh_.cage.boundary_tag = static_cast<int>(std::clamp<int64_t>(rule, 0, 2));
      mesh_.boundary = rule == 2 ? BoundaryRule::kEdgeOnly : BoundaryRule::kEdgeAndCorner;
    } else if (name == "smoothtriangles") {
      cage.smooth_triangles = !whole.empty() && whole[0] != 0;
    } else {
      mesh_.ignored.emplace_back("tag " + quote(name));
    }
  }

  bool hierarchical() const { return request_.name == "HierarchicalSubdivisionMesh"; }

  static constexpr uint32_t kDropped = ~0u;
  static constexpr int64_t kMaxPolygon = 1'000'000;  // corners
  RibStatement& request_;
  const RibDeclarations& declarations_;
  std::vector<RibNamedValue> parameters_;
  std::vector<size_t> corner_;  // of faces without holes: index of each corner in the file; empty: the same
  size_t corners_in_file_ = 0;
  RibMesh mesh_;
};

}  // namespace

RibMesh read_mesh(std::span<RibStatement> samples, const RibDeclarations& declarations) {
  RibMesh mesh = MeshReader(samples.front(), declarations).read();
  for (RibStatement& sample : samples.subspan(1)) {
    std::vector<std::string> undeclared;
    size_t first = 0;  // of the parameters: the first operand that is a single string after the arrays
    for (size_t i = sample.name.ends_with("SubdivisionMesh") ? 1 : 0; i < sample.arguments.size(); ++i) {
      first = i;
      if (!sample.arguments[i].is_number() && !sample.arguments[i].is_array) break;
    }
    std::vector<RibNamedValue> parameters = declarations.parameters(sample, first, undeclared);
    project_points(sample, parameters);
    mesh.samples.push_back(MeshReader::positions(sample, parameters, "P"));
    if (mesh.samples.back().size() != mesh.cage.positions.size())
      sample.fail("the meshes of a motion block must have the same number of points");
  }
  return mesh;
}

}  // namespace pelage
