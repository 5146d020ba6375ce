// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/schema.h"
#include "base/value_readers.h"
#include "base/vector.h"
#include "geom/mesh.h"

namespace pelage {

enum class UpAxis { kX, kY, kZ };
template <>
struct EnumNames<UpAxis> {
  static constexpr const char* names[] = {"x", "y", "z"};
};

/// Factors along x, y and z, which a scene writes as three numbers or as one. None may be 0.
struct ScaleFactors {
  V3f along{1};
};
template <>
struct ValueReader<ScaleFactors> {
  static bool read(const Value&, const KeyOptions&, ScaleFactors& out, Problems&);
  static std::string type_name() { return "number or 3 numbers"; }
  static std::string print(const ScaleFactors&) { return "1"; }
};

/// Length of a unit of a file in metres; 0: a scene unit. A scene writes m, cm, mm, inch, foot or metres.
struct FileUnit {
  float meters = 0;
};
template <>
struct ValueReader<FileUnit> {
  static bool read(const Value&, const KeyOptions&, FileUnit& out, Problems&);
  static std::string type_name() { return "m, cm, mm, inch, foot or metres"; }
  static std::string print(const FileUnit&) { return "a scene unit"; }
};

/// How the coordinates of a mesh or strand file become those of the scene at rest: first `up` is turned to y,
/// then lengths are converted from `units` and scaled, then rotated about x, y and z, then translated. A
/// product of scale factors below 0 mirrors the file.
struct FileTransformParams {
  ScaleFactors scale;
  V3f rotate{0};     ///< degrees
  V3f translate{0};  ///< scene units
  UpAxis up = UpAxis::kY;
  FileUnit units;
  float meters_per_unit = 0.01f;  ///< of the scene; no key of the block: load_scene() copies it from `units`

  /// Returns the matrix for row vectors: p * M.
  M44f matrix() const;
  static const Schema<FileTransformParams>& schema();
};

/// Returns the factor of lengths without a direction, such as widths: the cube root of the volume's factor.
float length_factor(const M44f& matrix);

/// Moves the positions of a cage. If the matrix mirrors, reverses the corners of each face, so that its outer
/// side stays outside.
void transform_cage(const M44f& matrix, ControlMesh& cage);

}  // namespace pelage
