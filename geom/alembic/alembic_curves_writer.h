// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "geom/alembic/alembic_writer.h"
#include "geom/strands.h"

namespace pelage {

/// The program that a file is made for.
enum class AlembicHost {
  kAny,
  /// Unreal Engine's importer of grooms: x, y and z become x, z and y, since its z points up and its axes are
  /// left-handed; strands are linear, through points on the curves, since it draws them so; and widths and
  /// colours are also parameters groom_width and groom_color of each vertex.
  kUnreal
};

struct AlembicCurvesFacts {
  bool widths = true;  ///< whether the strands have widths
  std::string group;   ///< parameter groom_group_name; empty: none
  AlembicHost host = AlembicHost::kAny;
};

/// Writes strands, at motion key 0, as a Curves object. Pinned B-splines and Catmull-Rom curves get their
/// phantom vertices at both ends, so that they are the same curves in every program that follows AbcGeom;
/// read_alembic_curves() removes them. Widths are "vtx", the values of phantom widths at least 0. Ids become
/// groom_id, root texture coordinates uv and groom_root_uv, both uniform, "color" becomes groom_color, and
/// "guide" groom_guide; all other attributes are parameters of their names.
void add_alembic_curves(AlembicWriter& writer, AlembicObjectWriter& parent, const std::string& name,
                        const Strands& strands, const AlembicCurvesFacts& facts);

/// Returns the names of the attributes that add_alembic_curves() does not write: those whose parameters would
/// have a name that the file has for something else, and those without a name. Of two attributes that differ
/// only in '/' and '_', the first is written.
std::vector<std::string> lost_alembic_attributes(const Strands& strands, const AlembicCurvesFacts& facts);

/// Returns an object with the identity as its transform, with the parameters that identify Unreal's groom
/// schema: groom_version_major 1, groom_version_minor 4 and groom_tool.
AlembicObjectWriter alembic_groom(AlembicWriter& writer, const std::string& name);

}  // namespace pelage
