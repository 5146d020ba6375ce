// SPDX-License-Identifier: Apache-2.0
#include "geom/alembic/alembic_curves_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "geom/alembic/alembic_curve_form.h"
#include "geom/alembic/alembic_param.h"
#include "geom/alembic/alembic_values.h"
#include "geom/io/file_transform.h"
#include "geom/usd/usd_curve_batch.h"

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
  AlembicCurvesReader(const UsdCurvesOptions& options, const std::filesystem::path& path,
                      UsdWarnings& warnings)
      : options_(options), place_{path.string(), 0, 0}, warnings_(warnings) {}

  void add(const AlembicNode& node) {
    node.note_unreadable(warnings_);
    if (!node.is_curves()) return;
    UsdCurveBatch batch;
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

  UsdCurvesFile finish(const AlembicScene& scene) {
    if (batches_.empty()) batches_.swap(guides_);
    if (!guides_.empty()) warnings_.add("guides (groom_guide) are skipped", place_);
    guides_.clear();
    if (batches_.empty()) fail_without(scene, "has no curves", warnings_);
    UsdCurvesFile file;
    const auto widthed = std::count_if(batches_.begin(), batches_.end(),
                                       [](const UsdCurveBatch& b) { return !b.widths.values.empty(); });
    if (widthed > 0 && widthed < static_cast<ptrdiff_t>(batches_.size()))
      warnings_.add("some curves have no widths; they get the default", place_);
    file.has_widths = widthed > 0;
    file.strands = join_usd_curves(std::move(batches_), [&](int64_t bytes) { charge(bytes); });
    file.warnings = warnings_.lines();
    return file;
  }

 private:
  /// Fails before memory is taken that does not fit.
  void charge(int64_t bytes) {
    bytes_ += bytes;
    if (bytes_ <= options_.max_bytes) return;
    throw Error(ErrorKind::kMemory, place_,
                fmt::format("reading the strands needs more than the free memory, {}",
                            memory_text(options_.max_bytes)));
  }

  bool add_vertices(const AlembicNode& node, const AlembicCurveForm& form, UsdCurveBatch& batch) {
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
    sizes_ = UsdPrimvarCounts{batch.counts.size(), 0, vertices, 0};
    for (const uint32_t n : batch.counts) sizes_.varying += form.varying(n);
    sizes_.face_varying = sizes_.varying;  // the same for curves
    return !batch.counts.empty();
  }

  std::optional<UsdPrimvar> param(const AlembicNode& node, const AlembicProperty* property,
                                  bool needed = false) {
    if (!property) return {};
    charge(static_cast<int64_t>(alembic_param_bytes(node.archive, *property)));
    return alembic_param(node, *property, sizes_, warnings_, needed);
  }

  void add_widths(const AlembicNode& node, UsdCurveBatch& batch) {
    set_widths(param(node, node.geometry.find("width"), true), batch);
    if (std::optional<UsdPrimvar> uv = param(node, node.geometry.find("uv"), true); uv && uv->components == 2)
      batch.root_uv = std::move(*uv);
  }
  static void set_widths(std::optional<UsdPrimvar> widths, UsdCurveBatch& batch) {
    if (!widths || widths->components != 1 || widths->values.empty() || !batch.widths.values.empty()) return;
    const float factor = 0.5f * length_factor(batch.to_world);
    for (float& width : widths->values) width *= factor;
    batch.widths = std::move(*widths);
  }

  /// Returns whether the curves are guides.
  bool add_params(const AlembicNode& node, UsdCurveBatch& batch) {
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

  void add_param(const AlembicNode& node, const AlembicProperty& property, UsdCurveBatch& batch) {
    if (batch.attributes.size() == kMaxCurveParams) {
      warnings_.add("parameters beyond the first 32 are skipped", place_);
      return;
    }
    const bool needed = property.name == "groom_width" || property.name == "groom_root_uv";
    std::optional<UsdPrimvar> values = param(node, &property, needed);
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
  bool is_guide(const AlembicNode& node, const AlembicProperty& property, UsdCurveBatch& batch) {
    std::optional<UsdPrimvar> guides = param(node, &property);
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

  void add_ids(const AlembicNode& node, const AlembicProperty& property, UsdCurveBatch& batch) {
    if (!batch.ids.empty() || !alembic_is_integer(property)) return;
    const size_t count = alembic_count(node.archive, property);
    if (count != batch.counts.size()) {
      warnings_.add("ids that are not one per curve are skipped", place_);
      return;
    }
    charge(static_cast<int64_t>(count) * kBytesPerId);
    const std::vector<int64_t> ids = alembic_integers(node.archive, property);
    batch.ids.assign(ids.begin(), ids.end());
  }

  static void drop_phantoms(UsdCurveBatch& batch) {
    const auto drop = [&](UsdPrimvar& values) {
      if (values.interpolation == "vertex") drop_ends(batch.counts, values.components, values.values);
    };
    drop_ends(batch.counts, 3, batch.points);
    drop(batch.widths);
    drop(batch.root_uv);
    for (auto& [name, values] : batch.attributes) drop(values);
    for (uint32_t& count : batch.counts) count = count > 2 ? count - 2 : 0;
  }

  const UsdCurvesOptions options_;
  const SourcePosition place_;
  UsdWarnings& warnings_;
  UsdPrimvarCounts sizes_;
  std::vector<UsdCurveBatch> batches_, guides_;
  int64_t bytes_ = 0;
};

}  // namespace

UsdCurvesFile read_alembic_curves(const std::filesystem::path& path, const UsdCurvesOptions& options) {
  UsdWarnings warnings;
  AlembicScene scene(path, warnings);
  AlembicCurvesReader reader(options, path, warnings);
  scene.visit([&](const AlembicNode& node) { reader.add(node); });
  return reader.finish(scene);
}

}  // namespace pelage
