// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_scene.h"

#include <numbers>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/alembic/alembic_values.h"

namespace pelage {
namespace {

constexpr int kMaxObjectDepth = 512;
constexpr size_t kMaxOps = 255;  // as many as a scalar holds, which programs write
constexpr size_t kMaxPathBytes = size_t(1) << 16;
constexpr std::string_view kTransformSchema = "AbcGeom_Xform_v3";

/// Operations of transforms, as the upper four bits of a byte number them, and how many numbers they have.
enum class TransformOp { kScale, kTranslate, kRotate, kMatrix, kRotateX, kRotateY, kRotateZ };
constexpr size_t kOpNumbers[] = {3, 3, 4, 16, 1, 1, 1};

Imath::M44d matrix_of_op(TransformOp op, const double* v) {
  constexpr double kToRadians = std::numbers::pi / 180;
  Imath::M44d m;
  const auto rotation = [&](const Imath::V3d& axis, double degrees) {
    if (axis.length() > 0) m.setAxisAngle(axis, degrees * kToRadians);
    return m;
  };
  switch (op) {
    case TransformOp::kScale:
      return m.setScale(Imath::V3d(v[0], v[1], v[2]));
    case TransformOp::kTranslate:
      return m.setTranslation(Imath::V3d(v[0], v[1], v[2]));
    case TransformOp::kRotate:
      return rotation(Imath::V3d(v[0], v[1], v[2]), v[3]);
    case TransformOp::kMatrix:
      for (size_t i = 0; i < 16; ++i) m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = v[i];
      return m;
    case TransformOp::kRotateX:
      return rotation(Imath::V3d(1, 0, 0), v[0]);
    case TransformOp::kRotateY:
      return rotation(Imath::V3d(0, 1, 0), v[0]);
    case TransformOp::kRotateZ:
      return rotation(Imath::V3d(0, 0, 1), v[0]);
  }
  return m;
}

M44f to_float(const Imath::M44d& m) {
  M44f result;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) result[i][j] = static_cast<float>(m[i][j]);
  }
  return result;
}

/// Returns whether an object is hidden. Its property `visible` is 0 if it is hidden, 1 if it is shown, and -1
/// or missing if it inherits the state of its parent.
bool is_hidden(const AlembicArchive& archive, const AlembicCompound& properties, bool parent_hidden) {
  const AlembicProperty* visible = properties.find("visible");
  const int64_t stated = visible ? alembic_first_integer(archive, *visible).value_or(-1) : -1;
  return stated < 0 ? parent_hidden : stated == 0;
}

}  // namespace

void AlembicNode::note_unreadable(ReadWarnings& warnings) const {
  if (schema.starts_with("AbcGeom_NuPatch") || schema.starts_with("AbcGeom_Points"))
    warnings.add("surfaces of NURBS and points are skipped", {archive.file().path().string(), 0, 0});
}

void AlembicNode::fail(const std::string& message) const {
  throw Error(ErrorKind::kInput, {archive.file().path().string(), 0, 0},
              visible(fmt::format("<{}>: {}", path, message)));
}

void fail_without(const AlembicScene& scene, std::string lacking, const ReadWarnings& warnings) {
  const std::string file = scene.archive().file().path().string(), prefix = visible(file + ": ");
  for (const std::string& line : warnings.lines())
    lacking += "; " + (line.starts_with(prefix) ? line.substr(prefix.size()) : line);
  throw Error(ErrorKind::kInput, {file, 0, 0}, lacking);
}

Imath::M44d alembic_transform(const AlembicArchive& archive, const AlembicCompound& transform,
                              bool& inherits) {
  const AlembicProperty* stated = transform.find(".inherits");
  inherits = !stated || alembic_first_integer(archive, *stated).value_or(1) != 0;
  Imath::M44d matrix;
  const AlembicProperty *ops = transform.find(".ops"), *values = transform.find(".vals");
  if (!ops || !values) return matrix;
  if (alembic_count(archive, *ops) > kMaxOps || alembic_count(archive, *values) > 16 * kMaxOps)
    archive.file().fail(fmt::format("a transform has more than {} operations", kMaxOps), ops->group.position);
  const std::vector<double> numbers = alembic_doubles(archive, *values);
  size_t next = 0;
  for (const int64_t encoded : alembic_integers(archive, *ops)) {
    const int64_t op = encoded >> 4;
    if (op < 0 || op > static_cast<int64_t>(TransformOp::kRotateZ))
      archive.file().fail(fmt::format("a transform has the unknown operation {}", op), ops->group.position);
    const size_t count = kOpNumbers[op];
    if (count > numbers.size() - next)
      archive.file().fail("a transform has too few numbers", values->group.position);
    // The last operation of the list applies to points first.
    matrix = matrix_of_op(static_cast<TransformOp>(op), &numbers[next]) * matrix;
    next += count;
  }
  return matrix;
}

/// What the children of an object inherit.
struct AlembicScene::Parent {
  Imath::M44d to_world;
  bool hidden = false;
  int depth = 0;
};

void AlembicScene::visit(const std::function<void(const AlembicNode&)>& use) {
  visited_.clear();
  path_.clear();
  visit_children(archive_.top(), {}, use);
}

void AlembicScene::visit_children(const AlembicObject& object, const Parent& parent,
                                  const std::function<void(const AlembicNode&)>& use) {
  const OgawaFile& file = archive_.file();
  const SourcePosition place{file.path().string(), 0, 0};
  if (parent.depth > kMaxObjectDepth)
    file.fail("objects are nested deeper than 512 levels", object.group.position);
  for (const AlembicObject& child : archive_.children(object)) {
    if (child.group.count > 0 && !visited_.insert(child.group.position).second)
      file.fail("an object is in two places", child.group.position);
    const std::string_view schema = alembic_metadata(child.metadata, "schema");
    const size_t parent_path = path_.size();
    path_.append("/").append(child.name);
    if (path_.size() > kMaxPathBytes)
      file.fail(fmt::format("the path of an object has more than {} bytes", kMaxPathBytes),
                child.group.position);
    Parent inner{parent.to_world, parent.hidden, parent.depth + 1};
    const AlembicCompound properties = archive_.properties(child);
    inner.hidden = is_hidden(archive_, properties, parent.hidden);
    if (properties.find(".instanceSource")) warnings_.add("instances are skipped", place);
    const AlembicProperty* transform = properties.find(".xform");
    if (schema == kTransformSchema && transform) {
      bool inherits = true;
      const AlembicCompound compound = archive_.compound(*transform);
      const Imath::M44d local = alembic_transform(archive_, compound, inherits);
      inner.to_world = inherits ? local * parent.to_world : local;
      const AlembicProperty* values = compound.find(".vals");
      if (values && values->stored > 1) warnings_.add("time samples after the first are skipped", place);
    } else if (const AlembicProperty* geometry = properties.find(".geom"); geometry && !schema.empty()) {
      if (inner.hidden) {
        warnings_.add("hidden objects are skipped", place);
      } else {
        use({archive_, path_, schema, archive_.compound(*geometry), to_float(inner.to_world), child});
      }
    }
    visit_children(child, inner, use);
    path_.resize(parent_path);
  }
}

}  // namespace pelage
