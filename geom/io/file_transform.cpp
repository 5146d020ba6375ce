// SPDX-License-Identifier: Apache-2.0
#include "geom/io/file_transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr std::array<std::pair<const char*, float>, 5> kUnits = {
    {{"m", 1.0f}, {"cm", 0.01f}, {"mm", 0.001f}, {"inch", 0.0254f}, {"foot", 0.3048f}}};

}  // namespace

bool ValueReader<ScaleFactors>::read(const Value& value, const KeyOptions& options, ScaleFactors& out,
                                     Problems& problems) {
  V3f factors;
  if (value.is_scalar()) {
    float factor = 0;
    if (!ValueReader<float>::read(value, options, factor, problems)) return false;
    factors = V3f(factor);
  } else if (!ValueReader<V3f>::read(value, options, factors, problems)) {
    return false;
  }
  if (factors.x * factors.y * factors.z == 0) {
    problems.add(value.position(), "a scale of 0 leaves nothing");
    return false;
  }
  out.along = factors;
  return true;
}

bool ValueReader<FileUnit>::read(const Value& value, const KeyOptions&, FileUnit& out, Problems& problems) {
  std::vector<std::string> names;
  if (value.is_scalar()) {
    for (const auto& [name, meters] : kUnits) {
      names.emplace_back(name);
      if (value.text() != name) continue;
      out.meters = meters;
      return true;
    }
    const std::optional<double> number = parse_number(value.text());
    if (number && *number > 1e-9 && *number < 1e9) {
      out.meters = static_cast<float>(*number);
      return true;
    }
  }
  problems.add(value.position(),
               "expected m, cm, mm, inch, foot or a number of metres from 1e-9 to 1e9, got " +
                   value.describe() + (value.is_scalar() ? suggest(value.text(), names) : ""));
  return false;
}

M44f FileTransformParams::matrix() const {
  const float to_radians = std::numbers::pi_v<float> / 180;
  M44f up_to_y, size, rotation, translation;
  if (up == UpAxis::kX) up_to_y = M44f(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  if (up == UpAxis::kZ) up_to_y = M44f(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  size.setScale(scale.along * (units.meters > 0 ? units.meters / meters_per_unit : 1.0f));
  rotation.setEulerAngles(rotate * to_radians);
  translation.setTranslation(translate);
  return up_to_y * size * rotation * translation;
}

float length_factor(const M44f& matrix) { return std::cbrt(std::abs(matrix.determinant())); }

void transform_cage(const M44f& matrix, ControlMesh& cage) {
  if (matrix == M44f()) return;
  for (V3f& point : cage.positions) point *= matrix;
  if (matrix.determinant() > 0) return;
  size_t first = 0;
  for (const uint32_t corners : cage.face_sizes) {
    const auto reverse = [&](std::vector<uint32_t>& values) {
      if (values.size() < first + corners) return;
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
      std::reverse(begin, begin + corners);
    };
    reverse(cage.face_vertices);
    reverse(cage.face_uv);
    first += corners;
  }
}

const Schema<FileTransformParams>& FileTransformParams::schema() {
  static const Schema<FileTransformParams> table = [] {
    Schema<FileTransformParams> s(
        "file transform",
        "How the coordinates of a mesh or a strand file become those of the scene at rest: `up` is turned "
        "to y, then lengths are converted from `units` and scaled, then rotated, then translated. Poses of a "
        "skin are transformed like its mesh.");
    s.set_example(R"(skins:
  cow: {mesh: cow.obj, transform: {up: z, units: m}}
  left_paw: {mesh: right_paw.obj, transform: {scale: [-1, 1, 1]}}   # mirrored)");
    s.key("scale", &FileTransformParams::scale,
          {.help = "Factor, or factors along x, y and z. Negative factors mirror: normals still point "
                   "outward"});
    s.key("rotate", &FileTransformParams::rotate,
          {.unit = "degrees", .help = "Rotation about x, then y, then z"});
    s.key("translate", &FileTransformParams::translate, {.unit = "scene units", .help = "Translation"});
    s.key("up", &FileTransformParams::up, {.help = "Axis that points up in the file; y points up in scenes"});
    s.key("units", &FileTransformParams::units,
          {.help = "Length of a unit of the file, as a name or in metres; Pelage converts to the scene's "
                   "`units`",
           .default_text = "a scene unit"});
    return s;
  }();
  return table;
}

}  // namespace pelage
