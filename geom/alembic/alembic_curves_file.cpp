// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curves_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "geom/alembic/alembic_curve_form.h"
#include "geom/alembic/alembic_param.h"
#include "geom/alembic/alembic_values.h"
#include "geom/interchange/curve_batch.h"

namespace pelage {
namespace {

// Bytes of memory per curve while counts and ids are read: as the file's integers, and as ours.
constexpr int64_t kBytesPerCount = sizeof(int64_t) + sizeof(uint32_t);
constexpr int64_t kBytesPerId = sizeof(int64_t) + sizeof(uint64_t);
constexpr size_t kMaxCurveParams = 32;

/// Removes the first and last element of each curve.
void drop_ends(const std::vector<uint32_t>& counts, size_t components, std::vector<float>& values) {
  size_t from = 0, to = 0;
  for (const uint32_t count : counts) {
    const size_t kept = count > 2 ? (count - 2) * components : 0;
    if (kept > 0)
      std::copy_n(values.begin() + static_cast<ptrdiff_t>(from + components), kept,
                  values.begin() + static_cast<ptrdiff_t>(to));
    from += count * components;
    to += kept;
  }
  values.resize(to);
}

class AlembicCurvesReader {
 public:
  AlembicCurvesReader(const CurvesReadOptions& options, const std::filesystem::path& path,
                      ReadWarnings& warnings)
      : place_{path.string(), 0, 0}, budget_(options.max_bytes), warnings_(warnings) {}

  void add(const AlembicNode& node) {
    node.note_unreadable(warnings_);
    if (!node.is_curves()) return;
    CurveBatch batch;
    const AlembicProperty *knots = node.geometry.find(".knots"), *counts = node.geometry.find("nVertices");
    if (knots && counts) {
      charge(static_cast<int64_t>(alembic_count(node.archive, *knots) * sizeof(float) +
                                  alembic_count(node.archive, *counts) * sizeof(int64_t)));
    }
    const std::optional<AlembicCurveForm> form = alembic_curve_form(node, warnings_);
    if (!form) return;
    batch.form = form->form;
    batch.to_world = node.to_world;
    if (!add_vertices(node, *form, batch)) return;
    add_widths(node, batch);
    const bool guide = add_params(node, batch);
    if (form->phantom_ends) drop_phantoms(batch);
    (guide ? guides_ : batches_).push_back(std::move(batch));
  }

  CurvesFile finish(const AlembicScene& scene) {
    if (batches_.empty()) batches_.swap(guides_);
    if (!guides_.empty()) warnings_.add("guides (groom_guide) are skipped", place_);
    guides_.clear();
    if (batches_.empty()) fail_without(scene, "has no curves", warnings_);
    return join_curves(std::move(batches_), place_, budget_, warnings_);
  }

 private:
  void charge(int64_t bytes) { budget_.charge(bytes, place_); }

  bool add_vertices(const AlembicNode& node, const AlembicCurveForm& form, CurveBatch& batch) {
    const AlembicProperty *counts = node.geometry.find("nVertices"), *points = node.geometry.find("P");
    if (!counts || !points || counts->stored == 0 || points->stored == 0) {
      warnings_.add("curves without points are skipped", place_);
      return false;
    }
    if (points->stored > 1 || counts->stored > 1)
      warnings_.add("time samples after the first are skipped", place_);
    for (const char* ignored : {".velocities", "w"}) {
      if (node.geometry.find(ignored)) warnings_.add("velocities and weights of points are skipped", place_);
    }
    if (points->extent != 3) node.fail(fmt::format("its points have {} coordinates", points->extent));
    const size_t vertices = alembic_count(node.archive, *points) / 3;
    charge(static_cast<int64_t>(3 * vertices * sizeof(float)) +
           static_cast<int64_t>(alembic_count(node.archive, *counts)) * kBytesPerCount);
    size_t sum = 0;
    const std::vector<int64_t> stated = alembic_integers(node.archive, *counts);
    batch.counts.reserve(stated.size());
    for (const int64_t count : stated) {
      if (count < 0) node.fail(fmt::format("a curve has {} points (nVertices)", count));
      if (static_cast<uint64_t>(count) > vertices - sum)
        node.fail(fmt::format("nVertices need more than the {} points", vertices));
      sum += static_cast<size_t>(count);
      batch.counts.push_back(static_cast<uint32_t>(count));
    }
    if (sum != vertices)
      node.fail(fmt::format("nVertices add up to {}, but there are {} points", sum, vertices));
    batch.points = alembic_floats(node.archive, *points);
    if (batch.points.size() != 3 * vertices) node.fail("the file changed while it was read");
    sizes_ = PrimvarCounts{batch.counts.size(), 0, vertices, 0};
    for (const uint32_t n : batch.counts) sizes_.varying += form.varying(n);
    sizes_.face_varying = sizes_.varying;  // the same for curves
    return !batch.counts.empty();
  }

  std::optional<Primvar> param(const AlembicNode& node, const AlembicProperty* property,
                               bool needed = false) {
    if (!property) return {};
    charge(static_cast<int64_t>(alembic_param_bytes(node.archive, *property)));
    return alembic_param(node, *property, sizes_, warnings_, needed);
  }

  void add_widths(const AlembicNode& node, CurveBatch& batch) {
    set_widths(param(node, node.geometry.find("width"), true), batch);
    if (std::optional<Primvar> uv = param(node, node.geometry.find("uv"), true); uv && uv->components == 2)
      batch.root_uv = std::move(*uv);
  }
  static void set_widths(std::optional<Primvar> widths, CurveBatch& batch) {
    if (!widths || widths->components != 1 || widths->values.empty() || !batch.widths.values.empty()) return;
    batch.set_widths(std::move(*widths));
  }

  /// Returns whether the curves are guides.
  bool add_params(const AlembicNode& node, CurveBatch& batch) {
    const AlembicProperty* arbitrary = node.geometry.find(".arbGeomParams");
    if (!arbitrary) return false;
    const AlembicCompound params = node.archive.compound(*arbitrary);
    bool guide = false;
    for (const AlembicProperty& property : params.properties) {
      if (property.name == "groom_guide") {
        guide = is_guide(node, property, batch);
      } else if (is_ids(property)) {
        add_ids(node, property, batch);
      } else if (property.name != "groom_version_major" && property.name != "groom_version_minor") {
        add_param(node, property, batch);
      }
    }
    return guide;
  }

  void add_param(const AlembicNode& node, const AlembicProperty& property, CurveBatch& batch) {
    if (batch.attributes.size() == kMaxCurveParams) {
      warnings_.add("parameters beyond the first 32 are skipped", place_);
      return;
    }
    const bool needed = property.name == "groom_width" || property.name == "groom_root_uv";
    std::optional<Primvar> values = param(node, &property, needed);
    if (!values) return;
    if (property.name == "groom_width") return set_widths(std::move(values), batch);
    if (property.name == "groom_root_uv" && values->components == 2) {
      batch.root_uv = std::move(*values);
      return;
    }
    const bool color = property.name == "groom_color" || property.name == "Cd";
    batch.attributes.emplace_back(color ? "color" : std::string(property.name), std::move(*values));
  }

  /// Curves are guides if all of them are: those of a constant, and of equal values. If some are, all are
  /// strands with an attribute.
  bool is_guide(const AlembicNode& node, const AlembicProperty& property, CurveBatch& batch) {
    std::optional<Primvar> guides = param(node, &property);
    if (!guides) return false;
    const auto marked =
        std::count_if(guides->values.begin(), guides->values.end(), [](float value) { return value != 0; });
    if (marked == 0 || marked == static_cast<ptrdiff_t>(guides->values.size())) return marked > 0;
    warnings_.add("guides among other curves (groom_guide) are read as strands with the attribute guide",
                  place_);
    batch.attributes.emplace_back("guide", std::move(*guides));
    return false;
  }

  static bool is_ids(const AlembicProperty& property) {
    return property.name == "groom_id" ||
           ((property.name == "ids" || property.name == "id") && alembic_is_integer(property));
  }

  void add_ids(const AlembicNode& node, const AlembicProperty& property, CurveBatch& batch) {
    if (!batch.ids.empty() || !alembic_is_integer(property)) return;
    const size_t count = alembic_count(node.archive, property);
    if (count != batch.counts.size()) {
      warnings_.add("ids that are not one per curve are skipped", place_);
      return;
    }
    charge(static_cast<int64_t>(count) * kBytesPerId);
    const std::vector<int64_t> ids = alembic_integers(node.archive, property);
    if (ids.size() != count) node.fail("the file changed while it was read");
    batch.ids.assign(ids.begin(), ids.end());
  }

  static void drop_phantoms(CurveBatch& batch) {
    const auto drop = [&](Primvar& values) {
      if (values.interpolation == "vertex") drop_ends(batch.counts, values.components, values.values);
    };
    drop_ends(batch.counts, 3, batch.points);
    drop(batch.widths);
    drop(batch.root_uv);
    for (auto& [name, values] : batch.attributes) drop(values);
    for (uint32_t& count : batch.counts) count = count > 2 ? count - 2 : 0;
  }

  const SourcePosition place_;
  ReadBudget budget_;
  ReadWarnings& warnings_;
  PrimvarCounts sizes_;
  std::vector<CurveBatch> batches_, guides_;
};

}  // namespace

CurvesFile read_alembic_curves(const std::filesystem::path& path, const CurvesReadOptions& options) {
  ReadWarnings warnings;
  AlembicScene scene(path, warnings);
  AlembicCurvesReader reader(options, path, warnings);
  scene.visit([&](const AlembicNode& node) { reader.add(node); });
  return reader.finish(scene);
}

}  // namespace pelage
