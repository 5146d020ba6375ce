// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/vector.h"
#include "geom/alembic/alembic_archive.h"
#include "geom/interchange/read_warnings.h"

namespace pelage {

/// A visible object of a scene: curves, a mesh, or something else that has a schema.
struct AlembicNode {
  const AlembicArchive& archive;
  const std::string& path;   ///< such as /rat/hair
  std::string_view schema;   ///< such as AbcGeom_Curve_v2
  AlembicCompound geometry;  ///< the properties of its schema
  M44f to_world;             ///< from the space of the object, for row vectors
  const AlembicObject& object;

  bool is_curves() const { return schema.starts_with("AbcGeom_Curve_"); }
  bool is_mesh() const {
    return schema.starts_with("AbcGeom_PolyMesh_") || schema.starts_with("AbcGeom_SubD_");
  }
  /// Adds a warning if objects of this kind are never read: surfaces of NURBS, and points.
  void note_unreadable(ReadWarnings& warnings) const;
  /// Throws Error (kInput) with the file and the path of the object.
  [[noreturn]] void fail(const std::string& message) const;
};

/// The objects of an Alembic file with their transforms, at the earliest sample. For use by one thread.
class AlembicScene {
 public:
  /// Adds a warning to `warnings` for everything that is skipped. Throws Error (kInput) as AlembicArchive
  /// does.
  AlembicScene(const std::filesystem::path& path, ReadWarnings& warnings)
      : archive_(path), warnings_(warnings) {}

  const AlembicArchive& archive() const { return archive_; }
  /// Visits the visible objects that have a schema other than a transform, in the order of the file. Throws
  /// Error (kInput) when objects contain themselves, are used twice, are nested deeper than 512 levels, or
  /// have paths of more than 64 KiB.
  void visit(const std::function<void(const AlembicNode&)>& use);

 private:
  struct Parent;
  void visit_children(const AlembicObject& object, const Parent& parent,
                      const std::function<void(const AlembicNode&)>& use);

  const AlembicArchive archive_;
  ReadWarnings& warnings_;
  std::set<uint64_t> visited_;  // positions of the groups of objects
  std::string path_;            // of the object that is visited
};

/// Throws Error (kInput) with the file, with what the file lacks ("has no curves"), and with all warnings,
/// which may give the reason.
[[noreturn]] void fail_without(const AlembicScene& scene, std::string lacking, const ReadWarnings& warnings);

/// Returns the matrix of a transform (a compound property .xform), for row vectors. `inherits`: whether the
/// transform of the parent applies, too. Throws Error (kInput) for malformed values.
Imath::M44d alembic_transform(const AlembicArchive& archive, const AlembicCompound& transform,
                              bool& inherits);

}  // namespace pelage
