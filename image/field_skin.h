// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/value_readers.h"
#include "base/vector.h"

namespace pelage {

class Field;
class TextureLibrary;
struct FieldPoint;

/// Values that are defined at every point of a skin. Immutable. Thread safety: at() may be called from any
/// thread.
class SkinValues {
 public:
  virtual ~SkinValues() = default;
  virtual Rgb at(const FieldPoint& point) const = 0;
  /// Returns the min and max of the first channel.
  virtual std::pair<float, float> range() const = 0;
};

/// A skin at rest, as fields see it. Thread safety: the functions may be called from any thread.
class FieldSkin {
 public:
  virtual ~FieldSkin() = default;
  /// The name of the skin, for messages: "skin 'rat'".
  virtual std::string name() const = 0;
  /// Box of the control vertices, rest space.
  virtual Box3f bounds() const = 0;
  /// Hash of the vertex colours and the groups of the mesh.
  virtual ContentHash attributes_hash() const = 0;
  /// Names of the groups of the mesh (g, o and usemtl).
  virtual std::vector<std::string> groups() const = 0;
  /// Returns 1 on the faces of a group, 0 elsewhere. `name` must be one of groups().
  virtual std::shared_ptr<const SkinValues> group(const std::string& name) const = 0;
  /// Returns the colours of the vertices, interpolated over faces; null if the mesh has none.
  virtual std::shared_ptr<const SkinValues> vertex_colors() const = 0;
  /// Returns the mean curvature in 1 / scene unit, > 0 where the skin is convex.
  virtual std::shared_ptr<const SkinValues> curvature() const = 0;
  /// Returns the distance from the line on the skin where `region` is 0.5, in scene units; null if the region
  /// has no such line on this skin.
  virtual std::shared_ptr<const SkinValues> distance_to_boundary(const Field& region) const = 0;
  /// Returns the distance from the mesh of an OBJ file, in scene units. Throws the errors of read_obj().
  virtual std::shared_ptr<const SkinValues> distance_to_mesh(const AssetPath& mesh) const = 0;
};

/// What fields are loaded from. Both must outlive the call that receives it.
struct FieldSources {
  FieldSources(TextureLibrary& library, const FieldSkin* on = nullptr) : textures(library), skin(on) {}
  TextureLibrary& textures;
  const FieldSkin* skin;  ///< null where there is no skin, or no single one
};

}  // namespace pelage
