// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_curves_file.h"

#include <algorithm>

#include <fmt/format.h>

#include "geom/interchange/curve_batch.h"
#include "geom/usd/usd_curve_form.h"
#include "geom/usd/usd_primvar.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

/// Max bytes of memory per byte of text while the numbers of a prim are read: a number has two characters or
/// more, arrays grow by doubling, and integers are in memory twice for a short time.
constexpr int64_t kMemoryPerText = 16;
/// Files seldom have more primvars; every strand may get a value of each.
constexpr size_t kMaxPrimvars = 32;

class UsdCurvesReader {
 public:
  UsdCurvesReader(const CurvesReadOptions& options, const std::filesystem::path& path)
      : file_{path.string(), 0, 0}, budget_(options.max_bytes) {}

  CurvesFile read(const UsdSource& source) {
    UsdStage stage(source, warnings_, [&](int64_t text_bytes) { hold_text(text_bytes); });
    stage.visit([&](const UsdPrim& prim) { add(prim); });
    if (batches_.empty()) throw Error(ErrorKind::kInput, file_, "has no curves");
    return join_curves(std::move(batches_), file_, budget_, warnings_);
  }

 private:
  /// The layers stay open until all prims are read, so the budget holds the most text that was open at once.
  void hold_text(int64_t bytes) {
    if (bytes <= text_bytes_) return;
    budget_.charge(bytes - text_bytes_, file_);
    text_bytes_ = bytes;
  }

  void add(const UsdPrim& prim) {
    if (prim.type == "NurbsCurves" || prim.type == "HermiteCurves")
      warnings_.add(prim.type + " prims are skipped", prim.position());
    if (prim.type != "BasisCurves") return;
    CurveBatch batch;
    const std::optional<CurveForm> form = usd_curve_form(prim);
    if (!form) {
      prim.fail(fmt::format("unknown curves: type '{}', basis '{}', wrap '{}'", prim.token("type", "cubic"),
                            prim.token("basis", "bezier"), prim.token("wrap", "nonperiodic")));
    }
    batch.form = *form;
    const int64_t reading = reading_bytes(prim);
    budget_.charge(reading, prim.position());
    add_vertices(prim, batch);
    add_widths(prim, batch);
    add_primvars(prim, batch);
    budget_.release(reading);
    if (batch.counts.empty()) return;
    budget_.charge(static_cast<int64_t>(batch.bytes()), prim.position());
    batches_.push_back(std::move(batch));
  }

  /// The max memory that the numbers of a prim need while they are read.
  static int64_t reading_bytes(const UsdPrim& prim) {
    int64_t bytes = 0;
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
      bytes += per_text * static_cast<int64_t>(value->text.end - value->text.begin);
    }
    return bytes;
  }

  void add_vertices(const UsdPrim& prim, CurveBatch& batch) {
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
    sizes_ = PrimvarCounts{batch.counts.size(), 0, static_cast<size_t>(vertices), 0};
    for (const uint32_t n : batch.counts) sizes_.varying += batch.form.varying(n);
    sizes_.face_varying = sizes_.varying;  // the same for curves
  }

  void add_widths(const UsdPrim& prim, CurveBatch& batch) {
    const std::string name = prim.find("primvars:widths") ? "primvars:widths" : "widths";
    std::optional<Primvar> widths = usd_primvar(prim, name, "vertex", sizes_, warnings_);
    if (!widths || widths->components != 1 || widths->values.empty()) return;
    batch.set_widths(std::move(*widths));
  }

  void add_primvars(const UsdPrim& prim, CurveBatch& batch) {
    static constexpr std::string_view kOwn[] = {"primvars:widths",       "primvars:ids",
                                                "primvars:id",           "primvars:groom:face",
                                                "primvars:groom:faceUv", "primvars:groom:priority"};
    add_ids(prim, batch);
    for (const std::string& name : prim.attribute_names()) {
      if (!name.starts_with("primvars:") || name.ends_with(":indices")) continue;
      if (std::find(std::begin(kOwn), std::end(kOwn), name) != std::end(kOwn)) continue;
      std::optional<Primvar> primvar = usd_primvar(prim, name, "constant", sizes_, warnings_);
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

  void add_ids(const UsdPrim& prim, CurveBatch& batch) {
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

  const SourcePosition file_;
  ReadBudget budget_;
  ReadWarnings warnings_;
  PrimvarCounts sizes_;
  std::vector<CurveBatch> batches_;
  int64_t text_bytes_ = 0;
};

}  // namespace

CurvesFile read_usd_curves(const UsdSource& source, const CurvesReadOptions& options) {
  return UsdCurvesReader(options, source.path).read(source);
}

}  // namespace pelage
