// SPDX-License-Identifier: Apache-2.0
#include "geom/usd/usd_primvar.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/visible_text.h"
#include "geom/usd/usd_values.h"

namespace pelage {
namespace {

void apply_indices(const UsdPrim& prim, const std::string& attribute, Primvar& primvar) {
  const std::optional<UsdValue> indices = prim.find(attribute + ":indices");
  if (!indices) return;
  const std::vector<int64_t> numbers = usd_integers(*indices->layer, indices->text);
  primvar.select(numbers.size(), [&](size_t i) {
    if (numbers[i] < 0 || static_cast<size_t>(numbers[i]) >= primvar.count()) {
      indices->layer->fail(indices->attribute->place, fmt::format("the index {} is not one of {} elements",
                                                                  numbers[i], primvar.count()));
    }
    return static_cast<size_t>(numbers[i]);
  });
}

}  // namespace

std::optional<Primvar> usd_primvar(const UsdPrim& prim, const std::string& attribute,
                                   const std::string& usual_interpolation, const PrimvarCounts& counts,
                                   ReadWarnings& warnings) {
  const std::optional<UsdValue> value = prim.find(attribute);
  if (!value) return {};
  const size_t components = usd_components(value->attribute->type);
  if (components == 0) return {};
  Primvar primvar;
  const int element_size = value->attribute->element_size;
  primvar.components = components * static_cast<size_t>(std::max(element_size, 1));
  if (primvar.components > kMaxPrimvarComponents) {
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
  if (counts.of(primvar.interpolation) == count) return primvar;
  if (primvar.interpolation == "constant" && count >= 1) {  // a constant array
    primvar.components = primvar.values.size();
    return primvar;
  }
  if (!stated.empty()) {
    warnings.add(fmt::format("'{}' has a size that does not fit its interpolation, {}", visible(attribute),
                             visible(stated)),
                 value->layer->position(value->attribute->place));
  }
  if (const char* fitting = counts.interpolation_of(count)) {
    primvar.interpolation = fitting;
    return primvar;
  }
  value->layer->fail(value->attribute->place,
                     fmt::format("'{}' has {} values; {} vertices, {} curves or faces need others",
                                 visible(attribute), count, counts.vertex, counts.uniform));
}

}  // namespace pelage
