// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_primvar.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

constexpr size_t kMaxElement = 16;

size_t count_of(const std::string& interpolation, const UsdPrimvarCounts& counts) {
  if (interpolation == "constant") return 1;
  if (interpolation == "uniform") return counts.uniform;
  if (interpolation == "varying") return counts.varying;
  if (interpolation == "vertex") return counts.vertex;
  if (interpolation == "faceVarying") return counts.face_varying;
  return SIZE_MAX;
}

void apply_indices(const UsdPrim& prim, const std::string& attribute, UsdPrimvar& primvar) {
  const std::optional<UsdValue> indices = prim.find(attribute + ":indices");
  if (!indices) return;
  std::vector<float> values;
  const std::vector<int64_t> numbers = usd_integers(*indices->layer, indices->text);
  values.reserve(numbers.size() * primvar.components);
  for (const int64_t index : numbers) {
    if (index < 0 || static_cast<size_t>(index) >= primvar.count()) {
      indices->layer->fail(indices->attribute->place,
                           fmt::format("the index {} is not one of {} elements", index, primvar.count()));
    }
    const auto first = primvar.values.begin() + index * static_cast<ptrdiff_t>(primvar.components);
    values.insert(values.end(), first, first + static_cast<ptrdiff_t>(primvar.components));
  }
  primvar.values = std::move(values);
}

}  // namespace

std::optional<UsdPrimvar> usd_primvar(const UsdPrim& prim, const std::string& attribute,
                                      const std::string& usual_interpolation, const UsdPrimvarCounts& counts,
                                      UsdWarnings& warnings) {
  const std::optional<UsdValue> value = prim.find(attribute);
  if (!value) return {};
  const size_t components = usd_components(value->attribute->type);
  if (components == 0) return {};
  UsdPrimvar primvar;
  const int element_size = value->attribute->element_size;
  primvar.components = components * static_cast<size_t>(std::max(element_size, 1));
  if (primvar.components > kMaxElement) {
    // Indices repeat elements, so long ones could take any amount of memory.
    warnings.add("primvars with more than 16 numbers per element are skipped",
                 value->layer->position(value->attribute->place));
    return {};
  }
  primvar.values = usd_floats(*value->layer, value->text, components);
  if (primvar.values.size() % primvar.components != 0) {
    value->layer->fail(value->attribute->place, "the number of values is no multiple of elementSize");
  }
  apply_indices(prim, attribute, primvar);
  const std::string stated = prim.interpolation(attribute);
  primvar.interpolation = stated.empty() ? usual_interpolation : stated;
  const size_t count = primvar.count();
  if (count_of(primvar.interpolation, counts) == count) return primvar;
  if (primvar.interpolation == "constant" && count >= 1) {  // a constant array
    primvar.components = primvar.values.size();
    return primvar;
  }
  if (!stated.empty()) {
    warnings.add(fmt::format("'{}' has a size that does not fit its interpolation, {}", visible(attribute),
                             visible(stated)),
                 value->layer->position(value->attribute->place));
  }
  for (const char* other : {"vertex", "varying", "uniform", "constant", "faceVarying"}) {
    if (count_of(other, counts) != count) continue;
    primvar.interpolation = other;
    return primvar;
  }
  value->layer->fail(value->attribute->place,
                     fmt::format("'{}' has {} values; {} vertices, {} curves or faces need others",
                                 visible(attribute), count, counts.vertex, counts.uniform));
}

}  // namespace pelage
