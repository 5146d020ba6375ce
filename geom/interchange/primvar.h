// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pelage {

/// Max numbers per element that readers accept: indices repeat elements, so elements of any length could take
/// any amount of memory.
inline constexpr size_t kMaxPrimvarComponents = 16;

/// Values on the curves or faces of an object, which USD calls a primvar and Alembic a geometry parameter.
/// Indices are resolved.
struct Primvar {
  std::string interpolation;  ///< constant, uniform, varying, vertex or faceVarying
  size_t components = 1;      ///< numbers per element
  std::vector<float> values;
  size_t count() const { return values.size() / components; }
  /// Replaces the elements by those that the indices select. `index(i)` returns index i of `count`; each must
  /// be below count().
  template <class Index>
  void select(size_t count, const Index& index) {
    std::vector<float> selected;
    selected.reserve(count * components);
    for (size_t i = 0; i < count; ++i) {
      const float* element = &values[index(i) * components];
      selected.insert(selected.end(), element, element + components);
    }
    values = std::move(selected);
  }
};

/// How many elements a primvar of an object has under each interpolation.
struct PrimvarCounts {
  size_t uniform = 0, varying = 0, vertex = 0, face_varying = 0;

  /// Returns the number under an interpolation; SIZE_MAX if it is unknown.
  size_t of(std::string_view interpolation) const;
  /// Returns the interpolation under which a primvar has `count` elements; null if there is none. Prefers
  /// vertex, then varying, uniform, constant and faceVarying.
  const char* interpolation_of(size_t count) const;
};

}  // namespace pelage
