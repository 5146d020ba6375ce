// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "base/value_readers.h"
#include "geom/io/host_geometry.h"
#include "geom/io/mesh_file.h"
#include "geom/io/strand_file.h"
#include "groom/coat/groom_params.h"
#include "image/host_image.h"
#include "python/arrays.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace pelage {
namespace {

using StrandsPointer = std::shared_ptr<Strands>;
constexpr auto kFloat = static_cast<py::ssize_t>(sizeof(float));

py::ssize_t size_of(size_t n) { return static_cast<py::ssize_t>(n); }

template <class T>
std::vector<T> copy_of(const InputArray<T>& array) {
  return {array.data(), array.data() + array.size()};
}

/// x, y, z (components 3 from 0) or the radius (one from 3) of all points: (motion keys, points, components).
py::object points_view(const StrandsPointer& s, int first, int components) {
  const py::ssize_t points = size_of(s->point_count());
  const std::vector<float>& all = s->arrays().points;
  return view_of(s, all.empty() ? nullptr : all.data() + first, {s->motion_keys(), points, components},
                 {4 * kFloat * points, 4 * kFloat, kFloat});
}

py::object root_faces(const StrandsPointer& s) {
  if (!s->has_roots()) return py::none();
  return view_of(s, &s->arrays().roots[0].face, {size_of(s->strand_count())}, {sizeof(RootAddress)});
}

py::object root_face_uv(const StrandsPointer& s) {
  if (!s->has_roots()) return py::none();
  return view_of(s, &s->arrays().roots[0].u, {size_of(s->strand_count()), 2}, {sizeof(RootAddress), kFloat});
}

py::object root_uv(const StrandsPointer& s) {
  const std::vector<V2f>& uv = s->arrays().root_uv;
  if (uv.empty()) return py::none();
  return view_of(s, &uv[0].x, {size_of(s->strand_count()), 2}, {2 * kFloat, kFloat});
}

py::dict attributes(const StrandsPointer& s) {
  py::dict all;
  for (const StrandAttribute& a : s->attributes()) {
    const py::ssize_t rows = size_of(a.values.size()) / a.components;
    all[py::str(a.name)] = view_of(s, a.values.data(), {rows, a.components}, {a.components * kFloat, kFloat});
  }
  return all;
}

CurveBasis basis_of(const std::string& name) {
  CurveBasis basis{};
  Problems problems;
  ValueReader<CurveBasis>::read(Value::scalar({"basis", 0, 0}, name), {}, basis, problems);
  problems.throw_if_any(ErrorKind::kArguments);
  return basis;
}

/// `points`: (points, 4) x, y, z and radius. pelage/_strands.py has checked all shapes and values.
StrandsPointer make_strands(const InputArray<float>& points, const InputArray<uint32_t>& offsets,
                            const InputArray<uint64_t>& ids, const std::string& basis,
                            const std::map<std::string, InputArray<float>>& attributes) {
  StrandArrays arrays;
  arrays.basis = basis_of(basis);
  arrays.points = copy_of(points);
  arrays.first_point = copy_of(offsets);
  arrays.ids = copy_of(ids);
  for (const auto& [name, values] : attributes) {
    const size_t rows = static_cast<size_t>(values.shape(0));
    const AttributeClass kind = rows == arrays.ids.size()          ? AttributeClass::kPerStrand
                                : rows * 4 == arrays.points.size() ? AttributeClass::kPerPoint
                                                                   : AttributeClass::kConstant;
    arrays.attributes.push_back({name, kind, static_cast<int>(values.shape(1)), copy_of(values)});
  }
  return std::make_shared<Strands>(std::move(arrays));
}

template <class V>
std::vector<V> vectors_of(const InputArray<float>& array) {
  std::vector<V> vectors(static_cast<size_t>(array.shape(0)));
  for (size_t i = 0; i < vectors.size(); ++i) {
    for (unsigned c = 0; c < V::dimensions(); ++c)
      vectors[i][static_cast<int>(c)] = array.data()[i * V::dimensions() + c];
  }
  return vectors;
}

std::shared_ptr<HostMesh> shared(ControlMesh mesh) {
  return std::const_pointer_cast<HostMesh>(share_mesh(std::move(mesh)));
}

std::shared_ptr<HostMesh> make_mesh(const InputArray<float>& points, const InputArray<uint32_t>& face_sizes,
                                    const InputArray<uint32_t>& face_vertices, const InputArray<float>& uv,
                                    const InputArray<uint32_t>& face_uv) {
  ControlMesh mesh;
  mesh.positions = vectors_of<V3f>(points);
  mesh.face_sizes = copy_of(face_sizes);
  mesh.face_vertices = copy_of(face_vertices);
  mesh.uv = vectors_of<V2f>(uv);
  mesh.face_uv = copy_of(face_uv);
  return shared(std::move(mesh));
}

std::shared_ptr<HostPoses> make_poses(const InputArray<float>& points) {
  std::vector<HostPoses::Pose> poses(static_cast<size_t>(points.shape(0)),
                                     HostPoses::Pose(static_cast<size_t>(points.shape(1))));
  const float* p = points.data();
  for (HostPoses::Pose& pose : poses) {
    for (V3f& point : pose) {
      point = {p[0], p[1], p[2]};
      p += 3;
    }
  }
  return std::const_pointer_cast<HostPoses>(share_poses(std::move(poses)));
}

/// `pixels`: (height, width, channels) of `T`.
template <class T>
std::shared_ptr<HostImage> make_image(const InputArray<T>& pixels, TexelKind kind) {
  const auto bytes = std::as_bytes(std::span(pixels.data(), static_cast<size_t>(pixels.size())));
  const TexelLayout layout{static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)),
                           static_cast<int>(pixels.shape(2)), kind};
  return std::const_pointer_cast<HostImage>(share_image(layout, {bytes.begin(), bytes.end()}));
}

StrandsPointer read_strands_of(const std::filesystem::path& path, const std::string& basis, float width) {
  StrandReadOptions options;
  if (!basis.empty()) options.basis = basis_of(basis);
  if (width > 0) options.default_width = width;
  const py::gil_scoped_release release;
  return std::make_shared<Strands>(read_strands(path, options).strands);
}

void bind_strands(py::module_& module) {
  py::class_<Strands, StrandsPointer>(module, "StrandBatch")
      .def_property_readonly("points", [](const StrandsPointer& s) { return points_view(s, 0, 3); })
      .def_property_readonly("radii", [](const StrandsPointer& s) { return points_view(s, 3, 1); })
      .def_property_readonly("offsets",
                             [](const StrandsPointer& s) {
                               const auto& first = s->arrays().first_point;
                               return view_of(s, first.data(), {size_of(first.size())}, {sizeof(uint32_t)});
                             })
      .def_property_readonly("ids",
                             [](const StrandsPointer& s) {
                               const auto& ids = s->arrays().ids;
                               return view_of(s, ids.data(), {size_of(ids.size())}, {sizeof(uint64_t)});
                             })
      .def_property_readonly("root_faces", root_faces)
      .def_property_readonly("root_face_uv", root_face_uv)
      .def_property_readonly("root_uv", root_uv)
      .def_property_readonly("attributes", attributes)
      .def_property_readonly("basis",
                             [](const Strands& s) { return ValueReader<CurveBasis>::print(s.basis()); })
      .def_property_readonly("bytes", &Strands::bytes)
      .def("__len__", &Strands::strand_count)
      .def(
          "write", [](const Strands& s, const std::filesystem::path& path) { write_strands(path, s); },
          py::call_guard<py::gil_scoped_release>())
      .def("what_is_lost",
           [](const Strands& s, const std::filesystem::path& path) { return what_is_lost(path, s); });
  module.def("make_strands", make_strands);
  module.def("read_strands", read_strands_of);
}

}  // namespace

void bind_geometry(py::module_& module) {
  bind_strands(module);
  py::class_<HostStrands, std::shared_ptr<HostStrands>>(module, "StrandData");
  module.def("share_strands", [](const StrandsPointer& strands) {
    return std::const_pointer_cast<HostStrands>(share_strands(strands));
  });
  py::class_<HostMesh, std::shared_ptr<HostMesh>>(module, "MeshData")
      .def_property_readonly("name", &HostMesh::name)
      .def_property_readonly("points",
                             [](const std::shared_ptr<HostMesh>& m) {
                               const auto& p = m->mesh().positions;
                               return view_of(m, &p[0].x, {size_of(p.size()), 3}, {3 * kFloat, kFloat});
                             })
      .def_property_readonly("face_sizes",
                             [](const std::shared_ptr<HostMesh>& m) {
                               const auto& sizes = m->mesh().face_sizes;
                               return view_of(m, sizes.data(), {size_of(sizes.size())}, {sizeof(uint32_t)});
                             })
      .def_property_readonly("face_vertices", [](const std::shared_ptr<HostMesh>& m) {
        const auto& corners = m->mesh().face_vertices;
        return view_of(m, corners.data(), {size_of(corners.size())}, {sizeof(uint32_t)});
      });
  py::class_<HostImage, std::shared_ptr<HostImage>>(module, "ImageData")
      .def_property_readonly("name", &HostImage::name);
  module.def("make_image8", [](const InputArray<uint8_t>& p) { return make_image(p, TexelKind::kU8); });
  module.def("make_image16", [](const InputArray<uint16_t>& p) { return make_image(p, TexelKind::kU16); });
  module.def("make_image", [](const InputArray<float>& p) { return make_image(p, TexelKind::kFloat); });
  py::class_<HostPoses, std::shared_ptr<HostPoses>>(module, "PoseData");
  module.def("make_poses", make_poses);
  module.def("make_mesh", make_mesh);
  module.def(
      "read_mesh", [](const std::filesystem::path& path) { return shared(read_mesh_file(path)); },
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace pelage
