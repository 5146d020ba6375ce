// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_curves_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/memory_budget.h"
#include "geom/io/file_transform.h"
#include "geom/usd/usd_curve_batch.h"
#include "geom/usd/usd_primvar.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

/// Bytes of memory per byte of text while a prim is read: a number has two characters or more, is in memory
/// twice for a short time, and resampled curves have six points per vertex.
constexpr int64_t kMemoryPerText = 16;
/// Primvars of files are seldom more; every strand may get a value of each.
constexpr size_t kMaxPrimvars = 32, kMaxPrimvarComponents = 16;

class UsdCurvesReader {
 public:
  UsdCurvesReader(const UsdCurvesOptions& options, UsdWarnings& warnings)
      : options_(options), warnings_(warnings) {}

  void add(const UsdPrim& prim) {
    if (prim.type == "NurbsCurves" || prim.type == "HermiteCurves")
      warnings_.add(prim.type + " prims are skipped", prim.position());
    if (prim.type != "BasisCurves") return;
    UsdCurveBatch batch;
    const std::string type = prim.token("type", "cubic"), basis = prim.token("basis", "bezier"),
                      wrap = prim.token("wrap", "nonperiodic");
    const std::optional<UsdCurveForm> form = UsdCurveForm::of(type, basis, wrap);
    if (!form) prim.fail(fmt::format("unknown curves: type '{}', basis '{}', wrap '{}'", type, basis, wrap));
    batch.form = *form;
    charge(prim);
    add_vertices(prim, batch);
    add_widths(prim, batch);
    add_primvars(prim, batch);
    if (batch.counts.empty()) return;
    strands_ += batch.counts.size();
    batches_.push_back(std::move(batch));
  }

  UsdCurvesFile finish(const std::filesystem::path& path) {
    if (batches_.empty()) throw Error(ErrorKind::kInput, {path.string(), 0, 0}, "has no curves");
    if (batches_.size() > 1 && bytes_ + joined_attribute_bytes(batches_) > options_.max_bytes)
      refuse({path.string()});
    UsdCurvesFile file;
    const bool unwidthed = std::any_of(batches_.begin(), batches_.end(),
                                       [](const UsdCurveBatch& b) { return b.widths.values.empty(); });
    const bool widthed = std::any_of(batches_.begin(), batches_.end(),
                                     [](const UsdCurveBatch& b) { return !b.widths.values.empty(); });
    if (unwidthed && widthed)
      warnings_.add("some curves have no widths; they get the default", {path.string()});
    file.has_widths = widthed;
    file.strands = join_usd_curves(std::move(batches_));
    file.warnings = warnings_.lines();
    return file;
  }

 private:
  /// Fails before the numbers of a prim are read if they do not fit.
  void charge(const UsdPrim& prim) {
    for (const std::string& name : prim.attribute_names()) {
      const std::optional<UsdValue> value = prim.find(name);
      if (!value) continue;
      int64_t per_text = kMemoryPerText;
      if (name.ends_with(":indices")) {
        // Each index, which has two characters or more, becomes an element.
        const std::optional<UsdValue> of = prim.find(name.substr(0, name.rfind(':')));
        const size_t size = of ? usd_components(of->attribute->type) *
                                     static_cast<size_t>(std::max(of->attribute->element_size, 1))
                               : 0;
        if (size <= kMaxPrimvarComponents) per_text *= static_cast<int64_t>(std::max<size_t>(size, 1));
      }
      bytes_ += per_text * static_cast<int64_t>(value->text.end - value->text.begin);
    }
    if (bytes_ > options_.max_bytes) refuse(prim.position());
  }
  [[noreturn]] void refuse(const SourcePosition& place) const {
    throw Error(ErrorKind::kMemory, place,
                fmt::format("reading the strands needs more than the free memory, {}",
                            memory_text(options_.max_bytes)));
  }

  void add_vertices(const UsdPrim& prim, UsdCurveBatch& batch) {
    const std::optional<UsdValue> counts = prim.find("curveVertexCounts"), points = prim.find("points");
    if (!counts || !points) {
      warnings_.add("curves without points are skipped", prim.position());
      return;
    }
    if (points->attribute->times.size() > 1)
      warnings_.add("time samples after the first are skipped", prim.position());
    batch.points = usd_floats(*points->layer, points->text, 3);
    int64_t sum = 0;
    const auto vertices = static_cast<int64_t>(batch.points.size() / 3);
    for (const int64_t count : usd_integers(*counts->layer, counts->text)) {
      if (count < 0) {
        counts->layer->fail(counts->attribute->place,
                            fmt::format("a curve has {} points (curveVertexCounts)", count));
      }
      if (count > vertices - sum) {
        counts->layer->fail(counts->attribute->place,
                            fmt::format("curveVertexCounts need more than the {} points", vertices));
      }
      sum += count;
      batch.counts.push_back(static_cast<uint32_t>(count));
    }
    if (sum != vertices) {
      counts->layer->fail(
          counts->attribute->place,
          fmt::format("curveVertexCounts add up to {}, but there are {} points", sum, vertices));
    }
    batch.to_world = prim.to_world;
    sizes_ = UsdPrimvarCounts{batch.counts.size(), 0, static_cast<size_t>(vertices), 0};
    for (const uint32_t n : batch.counts) sizes_.varying += batch.form.varying(n);
    sizes_.face_varying = sizes_.varying;  // the same for curves
  }

  void add_widths(const UsdPrim& prim, UsdCurveBatch& batch) {
    const std::string name = prim.find("primvars:widths") ? "primvars:widths" : "widths";
    std::optional<UsdPrimvar> widths = usd_primvar(prim, name, "vertex", sizes_, warnings_);
    if (!widths || widths->components != 1 || widths->values.empty()) return;
    const float factor = 0.5f * length_factor(batch.to_world);
    for (float& width : widths->values) width *= factor;
    batch.widths = std::move(*widths);
  }

  void add_primvars(const UsdPrim& prim, UsdCurveBatch& batch) {
    static constexpr std::string_view kOwn[] = {"primvars:widths",       "primvars:ids",
                                                "primvars:id",           "primvars:groom:face",
                                                "primvars:groom:faceUv", "primvars:groom:priority"};
    add_ids(prim, batch);
    for (const std::string& name : prim.attribute_names()) {
      if (!name.starts_with("primvars:") || name.ends_with(":indices")) continue;
      if (std::find(std::begin(kOwn), std::end(kOwn), name) != std::end(kOwn)) continue;
      std::optional<UsdPrimvar> primvar = usd_primvar(prim, name, "constant", sizes_, warnings_);
      if (!primvar || primvar->values.empty()) continue;
      if (primvar->components > kMaxPrimvarComponents || batch.attributes.size() == kMaxPrimvars) {
        warnings_.add("primvars of more than 16 numbers, or beyond the first 32, are skipped",
                      prim.position());
        continue;
      }
      std::string own = name.substr(std::string("primvars:").size());
      if (own == "st" && primvar->components == 2) {
        batch.root_uv = std::move(*primvar);
        continue;
      }
      if (own == "displayColor") own = "color";
      if (own == "displayOpacity") own = "opacity";
      batch.attributes.emplace_back(std::move(own), std::move(*primvar));
    }
  }

  void add_ids(const UsdPrim& prim, UsdCurveBatch& batch) {
    for (const char* name : {"primvars:ids", "ids", "primvars:id"}) {
      const std::optional<UsdValue> value = prim.find(name);
      if (!value || usd_components(value->attribute->type) != 1) continue;
      if (value->attribute->type == "float" || value->attribute->type == "double") continue;
      const std::vector<int64_t> ids = usd_integers(*value->layer, value->text);
      if (ids.size() != batch.counts.size()) {
        warnings_.add("ids that are not one per curve are skipped", prim.position());
        return;
      }
      batch.ids.assign(ids.begin(), ids.end());
      return;
    }
  }

  const UsdCurvesOptions options_;
  UsdWarnings& warnings_;
  UsdPrimvarCounts sizes_;
  std::vector<UsdCurveBatch> batches_;
  size_t strands_ = 0;
  int64_t bytes_ = 0;
};

UsdCurvesFile read_curves_of(UsdStage& stage, const std::filesystem::path& path,
                             const UsdCurvesOptions& options, UsdWarnings& warnings) {
  UsdCurvesReader reader(options, warnings);
  stage.visit([&](const UsdPrim& prim) { reader.add(prim); });
  return reader.finish(path);
}

}  // namespace

UsdCurvesFile read_usd_curves(const std::filesystem::path& path, const UsdCurvesOptions& options) {
  UsdWarnings warnings;
  UsdStage stage(path, warnings);
  return read_curves_of(stage, path, options, warnings);
}

UsdCurvesFile read_usd_curves(const std::filesystem::path& path, std::string_view text,
                              const UsdCurvesOptions& options) {
  UsdWarnings warnings;
  UsdStage stage(path, text, warnings);
  return read_curves_of(stage, path, options, warnings);
}

}  // namespace pelage
